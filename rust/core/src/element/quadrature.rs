//! Gauss points on the reference square.

/// Two-by-two Gauss rule on [-1, 1]^2: points (xi, eta), each of weight 1.
pub const GAUSS_2X2: [[f64; 2]; 4] = {
    const G: f64 = 0.577_350_269_189_625_8;
    [[-G, -G], [G, -G], [G, G], [-G, G]]
};
