"""Many PLCs: what runs side by side, what is checked, who is informed."""
