"""Files that are written completely or not at all, strict JSON and TOML, times in documents."""
