"""The plug-ins of the package, each in a folder that can be taken away. The pipeline imports none of them."""
