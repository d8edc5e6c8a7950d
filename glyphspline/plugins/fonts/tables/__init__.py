"""Tables of fonts: outlines of one master or of several."""
