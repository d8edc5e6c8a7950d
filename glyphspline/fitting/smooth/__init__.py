"""The smooth fit: closed C2 curves within a tolerance, for all contours of a batch at once, on flat arrays.

``canonical_contours`` the contours, each with its canonical start and direction · ``spacing`` first places for
vertices · ``respacing`` laid anew where spans fail · ``insertion`` vertices put into these, and graded · ``pruning``
vertices taken out · ``steps`` these for all contours in one call · ``refine`` the rounds of a fit · ``smooth_fit`` fits
measured.
"""
