from studies._printed import study as printed

study = printed("printed-wall", "Wall of concrete printed in 150 s", 150, 150)
