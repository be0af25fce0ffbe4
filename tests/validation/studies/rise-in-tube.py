import numpy as np
from studies._rise import rise

study = rise("rise-in-tube", "Rise in a tube", 0.06, 0.008, lambda x: np.hypot(x[:, 0], x[:, 1]) < 0.012)
