# What the words of sentences stand for: CASE.toml, its runs DIR, A and B, MORE of it, the files DATA and
# PARTICLES, whose name must say what it is.
. tests/docs/stage/import.sh
mkdir staged staged/docs
cp tests/docs/stage/CASE.toml staged
cp tests/docs/stage/CASE.toml staged/drop.toml
cp box.data staged/DATA
cp box.boid staged
for run in DIR A B; do treacle run staged/CASE.toml --quiet -o staged/$run; done
treacle run staged/CASE.toml --quiet -o staged/MORE --resume staged/DIR/checkpoint.h5 --end-time 0.03

apart() { # COMMAND: in a folder of its own
  local folder
  folder=$(mktemp -d inline.XXXXXX)
  cp -r staged/. "$folder"
  case $1 in *"-o DIR") rm -r "$folder/DIR" ;; esac
  (cd "$folder" && eval "${1/PARTICLES/box.boid}")
}

python3() { "$TREACLE_PYTHON" "$@"; } # what sentences have of Python is films
