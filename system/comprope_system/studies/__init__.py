"""The results of Nakazawa et al., "Lateral vibration analysis for elevator compensation rope", one study a module.

Each module has a `STUDY`. The paper's figures are known by what its text says of them.
"""
