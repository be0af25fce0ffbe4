# Sourced by gpu-run and profile, in the repository and in the folder of gpu-pack: where the programs are, and where
# the machine keeps NVIDIA's libraries and tools. Sets `programs`; expects `here`, the directory of the caller.

fail() {
  echo "${0##*/}: error: $*" >&2
  exit 2
}

# findPrograms DIR...: the first directory that holds treacle; TREACLE_BIN goes before them.
findPrograms() {
  local directory
  if [ -n "${TREACLE_BIN:-}" ]; then set -- "$TREACLE_BIN"; fi
  for directory; do
    if [ -x "$directory/treacle" ]; then
      programs=$(cd "$directory" && pwd)
      findLibraries
      return
    fi
  done
  fail "no treacle in $*; build it (cmake --preset gpu && cmake --build --preset gpu) or set TREACLE_BIN"
}

# cuSPARSE, which solve_benchmark and some tests need, and NCCL are too large to travel with the programs: those of the
# machine's toolkit, driver, system or Python packages.
findLibraries() {
  local name missing
  missing=$(ldd "$programs/treacle" 2>&1)
  for name in libcusparse.so.12 libnccl.so.2; do
    if grep -q "$name.*not found" <<<"$missing"; then findLibrary "$name"; fi
  done
}
findLibrary() {
  local library site
  site=$(python3 -c 'import sysconfig; print(sysconfig.get_paths()["purelib"])' 2>/dev/null || true)
  for library in /usr/local/cuda*/{lib,lib64,targets/*/lib}/"$1" /usr/local/nvidia/lib*/"$1" \
    ${site:+"$site"/nvidia/*/lib/"$1"}; do
    if [ -e "$library" ]; then
      export LD_LIBRARY_PATH=${library%/*}${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}
      return
    fi
  done
  fail "$1 is not on this machine; install the CUDA toolkit or NCCL, or pack with gpu-pack --with-cusparse"
}

requireGpu() {
  local info
  info=$("$programs/treacle" info) || fail "$programs/treacle does not start"
  grep -q "^CUDA *compiled" <<<"$info" || fail "$programs/treacle was built without CUDA"
  grep -q "^device" <<<"$info" || fail "no CUDA device on this machine (nvidia-smi shows what the driver sees)"
}

# findTool NAME: path of a tool of the CUDA toolkit that answers --version; nothing where there is none.
findTool() {
  local tool
  for tool in "$(command -v "$1" || true)" /usr/local/cuda*/bin/"$1" /usr/local/cuda*/compute-sanitizer/"$1" \
    /opt/nvidia/nsight-systems/*/bin/"$1" /opt/nvidia/nsight-compute/*/"$1"; do
    if [ -f "$tool" ] && [ -x "$tool" ] && "$tool" --version >/dev/null 2>&1; then
      echo "$tool"
      return
    fi
  done
}
