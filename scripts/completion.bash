# bash completion for galactic-run, galactic-pack, galactic-bake and galactic-dynamics: options, verbs and choices are read from
# --help, so that they are those of the tool that is installed.

# The lines of --help that tell of options: "  -o,--out FILE [default]   text".
_galactic_options() {
  "$@" --help 2>/dev/null | sed -nE 's/^ +((-[a-zA-Z0-9],)?--[a-z0-9-]+.*)$/\1/p'
}

_galactic() {
  local cur prev words cword
  _init_completion || return
  local tool=${words[0]} verb=""
  if [[ ${tool##*/} == galactic-pack ]]; then
    verb=${words[1]}
    if ((cword == 1)); then
      local verbs
      verbs=$("$tool" --help 2>/dev/null | sed -nE '/^Verbs:/,/^$/s/^  ([a-z]+) .*/\1/p')
      mapfile -t COMPREPLY < <(compgen -W "$verbs --help --version" -- "$cur")
      return
    fi
  fi
  local options
  options=$(_galactic_options "$tool" $verb)
  # After an option that takes one of a few words, these words. What has capitals stands for something else: FILE.pack
  # for files, LINK for what only a pack knows.
  if [[ $prev == -* ]]; then
    local choices words_of_choices
    choices=$(sed -nE "s/^(.*,)?${prev} ([a-z][^ |]*(\|[^ |]+)+).*/\2/p" <<<"$options" | head -n 1)
    if [[ -n $choices ]]; then
      words_of_choices=$(tr '|' '\n' <<<"$choices" | grep -v '[A-Z]')
      mapfile -t COMPREPLY < <(compgen -W "$words_of_choices" -- "$cur")
      [[ $choices != *FILE* ]] || _filedir
      return
    fi
  fi
  if [[ $cur == -* ]]; then
    local names
    names=$(sed -E 's/^(-[a-zA-Z0-9]),/\1 /; s/^((-[a-zA-Z0-9] )?--[a-z0-9-]+).*/\1/' <<<"$options")
    mapfile -t COMPREPLY < <(compgen -W "$names" -- "$cur")
    return
  fi
  _filedir
}

complete -F _galactic galactic-run galactic-pack galactic-bake galactic-dynamics
