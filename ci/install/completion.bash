# Completion of strata and strata-reference in bash. All that it offers comes from the programs' own help and lists, and from the scene that is named.

# Keys of the scene, with the names of its rocks and interfaces, a line each: "numerics.mechanics= explicit quasistatic".
_strata_keys() {
  named=$("$program" resolve "$scene" 2>/dev/null | sed -nE 's/^\[(rock|interface)\.([^.]*)\]$/\1 \2/p') awk -F ' *[|] *' '
    BEGIN {count = split(ENVIRON["named"], lines, "\n")}
    $2 ~ /^`[^[]*`$/ {
      gsub("`", "", $2); words = $5; gsub(",", "", words)
      if ($5 ~ /^[[(]|^formulas|^list$|^text$/) words = ""
      if ($2 !~ /NAME/) print $2 "=", words
      for (k = 1; k <= count; ++k) {split(lines[k], name, " "); key = $2; if (sub("^" name[1] "[.]NAME", name[1] "." name[2], key)) print key "=", words}
    }' < <("$program" keys)
}

# Inputs of a solution of strata-reference, a line each: "viscosity_Pa_s=".
_strata_inputs() {
  awk -v name="\"$command\"," '$1 == "\"name\":" {on = $2 == name} on && /^      "/ {gsub(/[":]/, "", $1); print $1 "="}' < <("$program")
}

# What is offered after --set, of such lines: keys, and behind "=" the words there are.
_strata_settings() {
  if [[ $current != *=* ]]; then
    compopt -o nospace 2>/dev/null
    offers=$(awk '{print $1}' <<<"$1")
  else
    offers=$(awk -v key="${current%%=*}=" '$1 == key {$1 = ""; print}' <<<"$1")
    [[ $COMP_WORDBREAKS == *=* ]] || prefix=${current%%=*}=  # else bash completes what follows "="
    current=${current#*=}
  fi
}

_strata_options() { "$program" "$@" --help 2>/dev/null | sed -nE 's/^  (-[-a-z,]+).*/\1/p' | tr , '\n'; }

_strata() {
  local program=$1 line=${COMP_LINE:0:COMP_POINT} words command scene="" word current="" prefix="" files="" offers=""
  read -ra words <<<"$line"
  [[ $line == *[[:space:]] ]] || { current=${words[-1]} && unset 'words[-1]'; }
  command=${words[1]-}
  for word in "${words[@]:2}"; do [[ $word != -* && -f $word ]] && scene=$word && break; done
  case ${program##*/}:${words[-1]}:$current in
    strata-reference:--set:*) _strata_settings "$(_strata_inputs)" ;;
    strata-reference:*) offers="$(_strata_options) $("$program" | sed -n 's/^    "name": "\(.*\)",/\1/p')" ;;
    *:--set:*) _strata_settings "$(_strata_keys)" ;;
    *:--variant:*) offers=$("$program" variants "$scene" 2>/dev/null) ;;
    *:--out:*) files=/ ;;  # folders alone
    *:--threads:* | *:--checkpoint-every:*) ;;
    *:-*) offers=$(_strata_options ${command:+"$command"}) ;;
    *)
      case $command in
        "") offers=$("$program" --help | sed -nE '/^Subcommands:/,$ s/^  ([a-z]+) .*/\1/p') ;;
        run | check | resolve | variants) files=*.toml ;;
        log) files=*.csv ;;
        resume) files=/ ;;
      esac ;;
  esac
  if [[ -n $files ]]; then
    compopt -o filenames 2>/dev/null
    mapfile -t COMPREPLY < <(compgen -d -- "$current"; compgen -f -X "!$files" -- "$current")
  else
    mapfile -t COMPREPLY < <(compgen -P "$prefix" -W "$offers" -- "$current")
  fi
}
complete -F _strata strata strata-reference
