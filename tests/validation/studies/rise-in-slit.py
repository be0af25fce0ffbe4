from studies._rise import slit

study = slit("rise-in-slit", "Rise in a slit", 0.05)
