//! Maps made from nothing: complete procedural materials and the analytic shapes that tests need.
