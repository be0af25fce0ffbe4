"""A small dam break in the formats of the authors' program (docs/import.md), in two dimensions: 4 x 6 particles
beside a wall of type 2 and on a floor of type 3."""

parameters = """# syrup
Dt                       1e-3
OutputInterval           5e-3
VtkOutputInterval        2e-3
EndTime                  4e-3
RadiusRatioA             3.5
RadiusRatioP             1.8
RadiusRatioV             3.4
Density                  1100   1000   900    800
BulkModulus              1e6    2e6    3e6    4e6
BulkViscosity            1e4    2e4    3e4    4e4
ShearViscosity           10     20     30     40
SurfaceTension           0      0      0      0
InteractionRatio(Type0)  1      1      1      1
Gravity                  0 -10 0
Wall2  Center 0 0 0  Velocity 0 0 0  Omega 0 0 0
Wall3  Center 0 0 0  Velocity 0 0 0  Omega 0 0 0
"""

cuboids = """# dam
ParticleDistance  1e-3
LowerDomain       -4e-3 -4e-3 -2e-3
UpperDomain       14e-3 14e-3  2e-3
StartCuboid
  Spacing   1e-3
  Type      1
  Lower     0 0 -0.5e-3
  Upper     4e-3 6e-3 0.5e-3
  Velocity  0.25 -0.5 0
EndCuboid
StartCuboid
  Spacing   1e-3
  Type      2
  Lower     -4e-3 -4e-3 -0.5e-3
  Upper     0 8e-3 0.5e-3
  Velocity  0 0 0
EndCuboid
StartCuboid
  Spacing   1e-3
  Type      3
  Lower     0 -4e-3 -0.5e-3
  Upper     14e-3 0 0.5e-3
  Velocity  0 0 0
EndCuboid
"""


def rows(type, corner, counts, velocity):
    """Particles whose cells fill a cuboid of counts from a corner, both in spacings of 1 mm, x first."""
    return "".join(
        f"{type} {' '.join(f'{1e-3 * (c + n + 0.5):e}' for c, n in zip(corner, (i, j, k), strict=True))} {velocity}\n"
        for k in range(counts[2])
        for j in range(counts[1])
        for i in range(counts[0])
    )


particles = (
    "0.0\n128 1e-3  -4e-3 14e-3  -4e-3 14e-3  -2e-3 2e-3\n"
    + rows(1, (0, 0, -0.5), (4, 6, 1), "0.25 -0.5 0")
    + rows(2, (-4, -4, -0.5), (4, 12, 1), "0 0 0")
    + rows(3, (0, -4, -0.5), (14, 4, 1), "0 0 0")
)


def replaced(text, old, new):
    """The text with the first place of old, which it must have, as new."""
    assert old in text, old
    return text.replace(old, new, 1)
