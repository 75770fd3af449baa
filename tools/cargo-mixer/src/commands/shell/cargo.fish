
# `cargo mixer ..` as `cargo-mixer ..`
function __fish_cargo_mixer
    complete -C (commandline -cp | string replace -r '^\s*cargo\s+mixer' cargo-mixer)
end
complete -c cargo -n '__fish_seen_subcommand_from mixer' -f -a '(__fish_cargo_mixer)'
