//! Judges techniques against the truth: FLIP, PSNR, hit errors, comparison sheets.
