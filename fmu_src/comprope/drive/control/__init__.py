"""Control of the drive: dynamics of the hoist, its plant along the shaft, servo loop and stability margins."""
