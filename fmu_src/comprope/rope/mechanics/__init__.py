"""Eq. (1) and (2): forces in rope and sheave contact, their tangents, boundary motion, energy and sensors."""
