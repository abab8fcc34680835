"""The data of a PLC beside its program: what a backup file keeps of them, and what each element is for."""
