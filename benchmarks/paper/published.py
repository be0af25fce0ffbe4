"""Numbers that the papers print, and iterations of the authors' program."""

# [K23 Table 1]; the exponents are lost in the scan ("104" for 10^4), and both ratios are named h_v: the first is h_p.
k23_base = {
    "spacing": 1e-3,
    "step": 1e-3,
    "gravity": 10,
    "dynamic_viscosity": 10,
    "bulk_viscosity": 1e4,
    "bulk_modulus": 1e6,
    "density": 1e3,
    "pressure_radius": 1.75,
    "viscosity_radius": 3.5,
    "particles": 400,
}

# [K23 Tables 2 and 4], column by column: spacing and step x 1e3, particles, d_mu, d_lambda, degrees of freedom, nonzeros,
# condition number, highest level.
columns = ("particles", "d_mu", "d_lambda", "dof", "nnz", "condition", "highest_level")
k23_scaled = {
    1: (400, 10, 1e3, 800, 6.16e4, 5.21e1, 2),
    2: (1600, 20, 2e3, 3200, 2.46e5, 2.05e2, 3),
    4: (6400, 40, 4e3, 12800, 9.85e5, 7.95e2, 4),
    8: (25600, 80, 8e3, 51200, 3.94e6, 3.00e3, 5),
    16: (102400, 160, 16e3, 204800, 1.58e7, 1.08e4, 6),
    32: (409600, 320, 32e3, 819200, 6.31e7, 3.57e4, 7),
    64: (1638400, 640, 64e3, 3276800, 2.52e8, 1.06e5, 8),
}
k23_cube = {
    0.5: (1000, 5, 0.5e3, 3000, 1.62e6, 1.31e1, 2),
    1: (8000, 10, 1e3, 24000, 1.29e7, 5.21e1, 3),
    2: (64000, 20, 2e3, 192000, 1.03e8, 2.05e2, 4),
    4: (512000, 40, 4e3, 1536000, 8.28e8, 7.95e2, 5),
}

# [O23 Table 1]; the kinematic viscosity is printed as 1e6 m2/s, where water has 1e-6.
o23 = {
    "spacing": 1.0,
    "step": 1e-2,
    "alpha": 1e-2,
    "density": 1e3,
    "kinematic_viscosity": 1e6,
    "steps": 4000,
    "particles": 58621,
}

# At 0.2 s, measured by running the authors' published program (double precision, one CPU thread; 2d-4 on 16 threads: 274).
authors_mgcr = {"2d-1": 243, "2d-2": 268, "2d-4": 288, "3d-0.5": 273, "3d-1": 325}
authors_cr = {"2d-1": 415, "2d-2": 611}
