# What a GPU is to compute the CPU does here.
treacle() {
  local words=()
  for word; do words+=("${word/#cuda/cpu}"); done
  command treacle "${words[@]}"
}
