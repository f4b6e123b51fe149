"""Reproduction of the results of Nakazawa et al., "Lateral vibration analysis for elevator compensation rope".

One study per module, its `STUDY`. Stated values are taken from the text of the paper.
"""
