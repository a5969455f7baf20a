"""On screen: `live`, `tour` and `replay`; `snapshot` saves a picture; `serve` is the lab in
a browser, by way of `web`."""
