"""Communication: topics, quality of service, and conversions of messages."""
