"""Files that appear whole or not at all, strict JSON and TOML, times in documents."""
