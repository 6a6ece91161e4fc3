"""The control space: how long is this edge, here?"""
