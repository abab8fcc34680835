"""Project files of the vendor's program, WinProladder (``.pdw``): bytes -> values. Reading only, no I/O."""
