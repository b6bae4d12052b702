"""A second program that attacks the diagnosis, written apart from it.

It makes tables as laboratories produce them, with remounting, errors of temperature control and broken isotherms,
puts faults into them that the catalogue has and has not, and holds the answer of `asphalt-nscd diagnose` against them.
`inside` puts faults into simulated bending tests too.
"""
