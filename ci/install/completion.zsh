#compdef strata strata-reference
# Completion in zsh: what bash's offers, from share/bash-completion of the same tree.
local rules=${functions_source[_strata]:A:h:h:h}/bash-completion/completions/strata
local -x COMP_LINE="${(j: :)words[1,CURRENT-1]} $PREFIX"
local -x COMP_POINT=$#COMP_LINE
local -a offers=(${(f)"$(bash --norc -c '. "$1"; COMP_WORDBREAKS=; _strata "$2"; printf "%s\n" "${COMPREPLY[@]}"' bash $rules ${(Q)words[1]})"})
local -a folders=(${^offers}(N-/))
compadd -q -S / -- $folders
compadd -S '' -- ${(M)offers:#*=}  # keys, whose values follow
compadd -- ${${offers:#*=}:|folders}
