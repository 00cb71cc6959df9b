//! Point collocation of elastic solids against closed forms.

mod boxes;
mod near_tip;
mod patch;
