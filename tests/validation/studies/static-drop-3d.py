from studies._tension import at_rest
from study import Level

study = at_rest(3, name="static-drop-3d", levels=[Level(1), Level(2)],
                bars={"Laplace pressure": 0.04, "spurious currents": 2e-3})
