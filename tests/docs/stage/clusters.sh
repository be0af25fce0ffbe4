cp tests/docs/stage/CASE.toml .
