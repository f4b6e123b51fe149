"""Operation of an elevator while its building sways: swing of the rope by car position and building period."""
