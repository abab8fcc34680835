"""Tests of the communication ports and the tables of CLINK and M-BUS, as values, jobs and commands."""
