# SPDX-License-Identifier: MIT
# Completion of servotrace for bash. Options come from the program's own help, so they cannot be out of date.
_servotrace() {
  local word=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]} command=${COMP_WORDS[1]}
  COMPREPLY=()
  if ((COMP_CWORD == 1)); then
    mapfile -t COMPREPLY < <(compgen -W "$(servotrace --help | sed -n 's/^  \([a-z]\{3,\}\) .*/\1/p')" -- "$word")
    return
  fi
  case $previous in
    --fail-on) mapfile -t COMPREPLY < <(compgen -W 'error warning note never' -- "$word"); return ;;
    --color | --progress) mapfile -t COMPREPLY < <(compgen -W 'auto always never' -- "$word"); return ;;
    --actor) mapfile -t COMPREPLY < <(compgen -W 'master drive network capture' -- "$word"); return ;;
    --select | --ignore)
      mapfile -t COMPREPLY < <(compgen -W "$(servotrace rules | cut -d' ' -f1)" -- "$word"); return ;;
    --output)
      if [[ $command == check || $command == merge ]]; then
        mapfile -t COMPREPLY < <(compgen -W 'text jsonl json sarif sarif-github junit github markdown' -- "$word")
        return
      fi ;;
  esac
  if [[ $word == -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$(servotrace "$command" --help 2>/dev/null | grep -oE -- '--[a-z][a-z-]*' | sort -u)" \
      -- "$word")
  elif [[ $command == explain ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$(servotrace rules | cut -d' ' -f1)" -- "$word")
  else
    mapfile -t COMPREPLY < <(compgen -f -- "$word")
  fi
}
complete -o filenames -F _servotrace servotrace
