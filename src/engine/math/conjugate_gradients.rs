//! Preconditioned conjugate gradients for A v = b, A symmetric and positive: the steps alone. Floor
//! 0. What A is, how it is preconditioned and how sums are folded belongs to the system that is
//! solved.

/// The steps of two sweeps of Jacobi in a multigrid preconditioner. They leave at most 0.22 of every
/// error between half the steepest and the steepest that a grid holds: Chebyshev's polynomial over
/// [½, 2].
pub const JACOBI_STEPS: [f32; 2] = [0.561_7, 1.389_5];

/// A system of equations with the buffers of its solution.
pub trait ConjugateSystem {
    /// z = M⁻¹ r; returns r · z.
    fn precondition(&mut self) -> f64;
    /// d = z + `turn` · d and p = A d; returns d · p.
    fn turn(&mut self, turn: f32) -> f64;
    /// v += `along` · d and r −= `along` · p; returns r · r.
    fn walk(&mut self, along: f32) -> f64;
}

/// Walks toward the solution and returns the number of steps.
///
/// * `left`: r · r where it begins.
/// * `is_done`: asked before each step, with its number and what is left then.
///
/// Stops early where the directions lead no further, as rounding makes them in the end.
pub fn conjugate_gradients(
    system: &mut impl ConjugateSystem,
    mut left: f64,
    most_steps: usize,
    mut is_done: impl FnMut(usize, f64) -> bool,
) -> usize {
    let mut rz_before = 0.0;
    for step in 0..most_steps {
        if is_done(step, left) {
            return step;
        }
        let rz = system.precondition();
        let turn = if step == 0 { 0.0 } else { (rz / rz_before) as f32 };
        let energy = system.turn(turn);
        if energy.is_nan() || energy <= 0.0 || rz <= 0.0 {
            return step;
        }
        left = system.walk((rz / energy) as f32);
        rz_before = rz;
    }
    most_steps
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two equations, not preconditioned: [4 1; 1 3] v = [1, 2].
    struct Pair {
        v: [f64; 2],
        r: [f64; 2],
        d: [f64; 2],
        p: [f64; 2],
    }

    fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
        a[0] * b[0] + a[1] * b[1]
    }

    impl ConjugateSystem for Pair {
        fn precondition(&mut self) -> f64 {
            dot(self.r, self.r)
        }

        fn turn(&mut self, turn: f32) -> f64 {
            self.d = [0, 1].map(|i| self.r[i] + f64::from(turn) * self.d[i]);
            self.p = [4.0 * self.d[0] + self.d[1], self.d[0] + 3.0 * self.d[1]];
            dot(self.d, self.p)
        }

        fn walk(&mut self, along: f32) -> f64 {
            let along = f64::from(along);
            self.v = [0, 1].map(|i| self.v[i] + along * self.d[i]);
            self.r = [0, 1].map(|i| self.r[i] - along * self.p[i]);
            dot(self.r, self.r)
        }
    }

    #[test]
    fn two_equations_are_solved_in_two_steps() {
        let mut pair = Pair { v: [0.0; 2], r: [1.0, 2.0], d: [0.0; 2], p: [0.0; 2] };
        let steps = conjugate_gradients(&mut pair, 5.0, 10, |_, left| left < 1e-10);
        assert_eq!(steps, 2);
        assert!((pair.v[0] - 1.0 / 11.0).abs() < 1e-6, "{:?}", pair.v);
        assert!((pair.v[1] - 7.0 / 11.0).abs() < 1e-6, "{:?}", pair.v);
    }

    #[test]
    fn a_system_without_a_right_hand_side_takes_no_step() {
        let mut pair = Pair { v: [0.0; 2], r: [0.0; 2], d: [0.0; 2], p: [0.0; 2] };
        assert_eq!(conjugate_gradients(&mut pair, 0.0, 10, |_, _| false), 0);
    }
}
