"""A tour of the lab in eight steps.  `steps` is the table: what is set, what is waited for, what is said and asked.
`guide` sets each step, waits for its moment in a lab and knows what to say; `told` prints it where there is no screen.
"""
