//! Draws a Relievo scene on the CPU, on all cores.
