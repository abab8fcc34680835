"""Requests and answers: time-outs, retries, fences, streams. The only code that sends requests to a PLC."""
