# Sourced by the other scripts: phases with a heading each, quiet unless they fail.

# Folder of this checkout, whatever the current folder is.
galactic_root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
log_folder=$galactic_root/build/logs

heading() { printf '\n== %s\n' "$*"; }

# phase NAME TITLE COMMAND...: runs COMMAND with its output in build/logs/NAME.log; on failure shows
# the end of it and returns the command's exit code.
phase() {
  local name=$1 title=$2 code=0 start=$SECONDS
  shift 2
  heading "$title"
  mkdir -p "$log_folder"
  "$@" >"$log_folder/$name.log" 2>&1 </dev/null || code=$?
  if [ "$code" -ne 0 ]; then
    tail -n 60 "$log_folder/$name.log"
    printf '   failed with exit code %d; everything it said: build/logs/%s.log\n' "$code" "$name"
    return "$code"
  fi
  printf '   done in %d s\n' $((SECONDS - start))
}
