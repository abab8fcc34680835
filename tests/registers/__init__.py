"""Tests of reading, writing, forcing, snapshots and watching, as jobs and as commands."""
