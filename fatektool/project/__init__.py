"""Project files of the vendor's software, WinProladder (``.pdw``): bytes -> values. Reading only, no I/O."""
