from studies._tension import at_rest
from study import Level

study = at_rest(2, name="static-drop", levels=[Level(1), Level(2), Level(4)],
                bars={"Laplace pressure": 0.03, "spurious currents": 1e-3}, orders={"Laplace pressure": 0.8})
