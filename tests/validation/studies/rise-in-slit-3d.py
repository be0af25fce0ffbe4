from studies._rise import slit

study = slit("rise-in-slit-3d", "Rise in a slit in three dimensions", 0.08)
