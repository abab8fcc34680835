"""Is a PLC as it ought to be, with its program and its last backup?"""
