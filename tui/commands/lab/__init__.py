"""On screen: `live`, `replay`, and their `keys`; `snapshot` saves a picture."""
