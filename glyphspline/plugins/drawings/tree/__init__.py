"""SVG drawings as browsers see them: the tree of elements resolved into shapes, one file a subject.

:mod:`.document` parses, :mod:`.structure` walks, :mod:`.ink` makes contours of what is painted; the others are what
these need: styles, paint, lengths, transforms, shapes, path data, clips, strokes. What is seen in a browser and is not
resolved here is named: see :class:`.unread.Unread`.
"""
