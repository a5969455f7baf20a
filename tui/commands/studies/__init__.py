"""Without a screen: `run` judges; `accuracy` and `stability` study, and print with `reports`."""
