"""What a user asks for: values in, values out, progress by callback, no printing."""
