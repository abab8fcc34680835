"""Many PLCs: fleet, check, alarms."""
