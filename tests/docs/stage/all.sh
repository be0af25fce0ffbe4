# Before the commands of every page; $source is the repository.

# What `treacle run CASE.toml [options]` does, but sixteen steps of it, or as long as sixteen of the longest where steps are
# automatic, with a frame each, by twice the spacing where the case allows it.
firstSteps() {
  local case=$1 overrides=() others=() coarse=(--set resolution=0.5) step
  shift
  while [ $# -gt 0 ]; do
    case $1 in
      --end-time) shift ;;
      --set)
        overrides+=("$1" "$2")
        shift
        ;;
      *) others+=("$1") ;;
    esac
    shift
  done
  treacle check "$case" "${overrides[@]}" "${coarse[@]}" >/dev/null 2>&1 || coarse=()
  overrides+=("${coarse[@]}")
  step=$(treacle check "$case" "${overrides[@]}" |
    awk '/^\[/ { section = $1 } section == "[time]" { is[$1] = $3 }
      END { print is["step"] == "\"auto\"" ? is["max_step"] : is["step"] }')
  treacle run "$case" "${others[@]}" "${overrides[@]}" --set output.interval="$step" \
    --end-time "$(awk "BEGIN { print 16 * $step }")"
}

# Two processes of one thread, however many are named: tests have one core, and threads that share it wait long.
mpirun() {
  local words=() before= word
  for word; do
    case $before in
      -n) word=2 ;;
      --threads) word=1 ;;
    esac
    words+=("$word")
    before=$word
  done
  command mpirun "${words[@]}"
}
