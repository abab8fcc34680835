"""The programs of simulated PLCs."""
