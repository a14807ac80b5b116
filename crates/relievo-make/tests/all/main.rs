//! Generated materials, paintings, photographs and recipes by the public API.

mod materials;
mod paintings;
mod photos;
mod recipes;
