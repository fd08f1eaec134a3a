"""What goes over the wire: topics, quality of service, conversions."""
