# Completion of strata and strata-reference in bash. All it offers comes from the programs' own help and lists, and from the scene that is named.

# _strata_settings KEYS: keys with "=", and behind "=" the words in the second column; bash completes there what follows "=".
_strata_settings() {
  local key=${current%%=*}
  if [[ $current == *=* ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$(awk -v key="$key=" '$1 == key {$1 = ""; print}' <<<"$1")" -- "${current#*=}")
  else
    mapfile -t COMPREPLY < <(compgen -W "$(awk '{print $1}' <<<"$1")" -- "$current")
    compopt -o nospace 2>/dev/null
  fi
}

# Of a scene the keys with the names of its rocks and interfaces: "numerics.shape= bspline2 linear gimp".
_strata_keys() {
  local named
  named=$("$program" resolve "$scene" 2>/dev/null | sed -nE 's/^\[(rock|interface)\.([^.]*)\]$/\1 \2/p')
  "$program" keys | awk -F ' *[|] *' -v named="$named" '
    BEGIN {count = split(named, lines, "\n")}
    $2 ~ /^`[^[]*`$/ {
      gsub("`", "", $2); words = $5; gsub(",", "", words)
      if ($5 ~ /^[[(]|^formulas|^list$|^text$/) words = ""
      if ($2 !~ /NAME/) print $2 "=", words
      for (k = 1; k <= count; ++k) {split(lines[k], name, " "); key = $2; if (sub("^" name[1] "[.]NAME", name[1] "." name[2], key)) print key "=", words}
    }'
}

# Sets options: those of the command.
_strata_options() { options=$("$program" "$@" --help 2>/dev/null | sed -nE 's/^  (-[-a-z,]+).*/\1/p' | tr , '\n'); }

_strata() {
  local program=$1 line=${COMP_LINE:0:COMP_POINT} words options command scene="" word current="" before
  read -ra words <<<"$line"
  [[ $line == *[[:space:]] ]] || { current=${words[-1]} && unset 'words[-1]'; }
  before=${words[-1]} command=${words[1]-}
  COMPREPLY=()
  for word in "${words[@]:2}"; do [[ $word != -* && -f $word ]] && scene=$word && break; done
  if [[ ${program##*/} == strata-reference ]]; then
    local list
    list=$("$program")
    if [[ $before == --set ]]; then
      _strata_settings "$(awk -v name="\"$command\"," '$1 == "\"name\":" {on = $2 == name} on && /^      "/ {gsub(/[":]/, "", $1); print $1 "="}' <<<"$list")"
    else
      _strata_options
      mapfile -t COMPREPLY < <(compgen -W "$options $(awk '/^    "name":/ {gsub(/[",]/, "", $2); print $2}' <<<"$list")" -- "$current")
    fi
    return
  fi
  if [[ ${#words[@]} -eq 1 ]]; then
    _strata_options
    mapfile -t COMPREPLY < <(compgen -W "$options $("$program" --help | sed -nE '/^Subcommands:/,$ s/^  ([a-z]+) .*/\1/p')" -- "$current")
    return
  fi
  case $before in
    --set) _strata_settings "$(_strata_keys)" ;;
    --variant) mapfile -t COMPREPLY < <(compgen -W "$("$program" variants "$scene" 2>/dev/null)" -- "$current") ;;
    --out) mapfile -t COMPREPLY < <(compgen -d -- "$current") && compopt -o filenames 2>/dev/null ;;
    --threads | --checkpoint-every) ;;
    *)
      if [[ $current == -* ]]; then
        _strata_options "$command"
        mapfile -t COMPREPLY < <(compgen -W "$options" -- "$current")
        return
      fi
      case $command in
        run | check | resolve | variants) word='*.toml' ;;
        log) word='*.csv' ;;
        resume) word='/' ;;  # folders alone
        *) return ;;
      esac
      mapfile -t COMPREPLY < <(compgen -d -- "$current" && compgen -f -X "!$word" -- "$current")
      compopt -o filenames 2>/dev/null ;;
  esac
}
complete -F _strata strata strata-reference
