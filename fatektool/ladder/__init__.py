"""The ladder program in the vendor's mnemonics: words <-> instructions <-> networks. No I/O."""
