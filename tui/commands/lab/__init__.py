"""On screen: `live`, `tour`, `replay`, and their `keys`; `snapshot` saves a picture; `serve` is the lab in
a browser, by way of `web`."""
