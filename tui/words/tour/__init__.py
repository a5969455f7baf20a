"""A tour of the lab in eight steps.  `steps` is the table: scene, moment, sentence, question and answer of each.
`guide` starts a step in a lab and waits for its moment; `told` prints the tour where there is no screen.
"""
