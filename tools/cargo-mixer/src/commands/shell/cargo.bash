
complete -F _cargo_mixer -o bashdefault -o default cargo-mixer

# `cargo mixer ..` as `cargo-mixer ..`; all else goes to cargo's own completion, loaded where it is not yet.
_cargo_own_completion() {
    complete -p cargo 2>/dev/null | sed -n 's/.* -F \([^ ]*\) .*/\1/p'
}
_cargo_own=$(_cargo_own_completion)
_cargo_with_mixer() {
    if [[ ${COMP_WORDS[1]} == mixer && $COMP_CWORD -gt 1 ]]; then
        COMP_WORDS=("${COMP_WORDS[@]:1}")
        COMP_CWORD=$((COMP_CWORD - 1))
        _cargo_mixer mixer "$2" "$3"
        return
    fi
    if [[ -z $_cargo_own ]] && declare -F _completion_loader >/dev/null; then
        complete -r cargo
        _completion_loader cargo
        _cargo_own=$(_cargo_own_completion)
        complete -F _cargo_with_mixer -o bashdefault -o default cargo
    fi
    [[ -z $_cargo_own || $_cargo_own == _cargo_with_mixer ]] || "$_cargo_own" "$@"
}
[[ $_cargo_own == _cargo_with_mixer ]] || complete -F _cargo_with_mixer -o bashdefault -o default cargo
