"""The measured volume of the fluid against Voronoi cells, which no weight of a sum and no arrangement of particles can bias."""

import numpy as np
import pytest
import treacle

spatial = pytest.importorskip("scipy.spatial")

SPACING = 1e-3


def heap(dimensions, bulk_modulus, radius):
    """A ball of fluid that its weight flattens on a floor, and compresses where the bulk modulus is small."""
    width = [3 * radius] * (dimensions - 1)
    low = [-w for w in width]
    return {
        "dimensions": dimensions,
        "spacing": SPACING,
        "domain": {"min": [*low, -4 * SPACING], "max": [*width, 3 * radius]},
        "gravity": {"acceleration": [0] * (dimensions - 1) + [-9.81]},
        "time": {"step": 1e-3, "end": 0.06},
        "material": [
            {"name": "resin", "density": 1400, "dynamic_viscosity": 5, "bulk_viscosity": 1e-2 * bulk_modulus, "bulk_modulus": bulk_modulus}
        ],
        "body": [
            {"name": "ball", "type": "fluid", "material": "resin", "shape": "sphere", "center": [0] * (dimensions - 1) + [radius], "radius": radius},
            {"name": "floor", "type": "wall", "material": "resin", "shape": "box", "min": [*low, -4 * SPACING], "max": [*width, 0]},
        ],
    }


def size_of(corners):
    """Of a Voronoi cell, which is convex."""
    return spatial.ConvexHull(corners).volume


def density_by_cells(fluid, walls, depth=2.5):
    """Of the fluid over that of its material, by the cells of particles from which open cells and walls are `depth` spacings away."""
    dimensions = fluid.shape[1]
    cells = spatial.Voronoi(np.vstack([fluid, walls]))
    sizes = np.full(len(fluid), np.nan)
    for i, place in enumerate(fluid):
        region = cells.regions[cells.point_region[i]]
        if region and -1 not in region:
            corners = cells.vertices[region]
            if np.max(np.linalg.norm(corners - place, axis=1)) < 1.6 * SPACING:
                sizes[i] = size_of(corners)
    outside = np.vstack([fluid[np.isnan(sizes)], walls])
    inside = spatial.cKDTree(outside).query(fluid)[0] > depth * SPACING
    return SPACING**dimensions / sizes[inside].mean(), inside.sum()


@pytest.mark.parametrize(("dimensions", "radius"), [(2, 0.015), (3, 0.009)])
@pytest.mark.parametrize("bulk_modulus", [4e3, 1e6])
def test_measured_density_is_that_of_the_cells(dimensions, radius, bulk_modulus):
    sim = treacle.Simulation(heap(dimensions, bulk_modulus, radius), backend="cpu")
    sim.run(progress=False)
    found, count = density_by_cells(np.asarray(sim.fluid.positions), np.asarray(sim.walls.positions))
    assert count > 60
    measured = sim.history["mean_density"][-1]
    print(dimensions, bulk_modulus, found, count, measured)
    assert measured == pytest.approx(found, abs=3e-3)
