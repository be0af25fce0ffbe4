cp tests/docs/stage/CASE.toml .

# A run, and the particles that another solver gives.
treacle run cases/dam-break-2d.toml --quiet
treacle run cases/dam-break-2d.toml --quiet -o other --set solver.krylov=cr
PYTHONPATH=scripts python3 - <<'END'
import treacle_data

frame = treacle_data.Run("other").frame()
with open("other.csv", "w") as file:
    print("x,y,u,v", file=file)
    for position, velocity in zip(frame.position, frame.velocity):
        print(*position, *velocity, sep=",", file=file)
END
