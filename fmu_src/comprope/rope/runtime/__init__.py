"""What every kernel builds on: compilation, SIMD values, the parameter vector, array layout and status codes."""
