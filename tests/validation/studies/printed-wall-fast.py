from studies._printed import study as printed

study = printed("printed-wall-fast", "Wall of concrete printed in 75 s", 75, 68.5)
