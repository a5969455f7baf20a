"""Phase space (F3, and a pane of the lab): theta across, omega up.

`view` holds the `pane` and a table.  For each sample, `viewport` maps (theta, omega) to dots,
`portrait` has the curves of equal energy there, `picture` draws the methods on them, and `facts`
are the words and numbers below.  In the view, the pane can show instead the `section` of a method's
own map, which fills in as it is computed.
"""
