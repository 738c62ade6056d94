"""Seeing a dataset: in 3D in a browser, as videos with the labels drawn in, as one page of all sequences."""
