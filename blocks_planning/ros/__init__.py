"""The ROS 2 graph: each part of a trial as a node. No other folder uses the middleware."""
