//! A generator that is the same everywhere: splitmix64 (Steele, Lea, Flood 2014).

/// State of the generator.
pub(super) struct SplitMix(u64);

impl SplitMix {
    pub(super) fn new(seed: u64) -> Self {
        Self(seed)
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// Uniform in [0, 1), from the upper 53 bits.
    fn uniform(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Uniform in [low, high).
    pub(super) fn within(&mut self, [low, high]: [f64; 2]) -> f64 {
        low + (high - low) * self.uniform()
    }

    /// One of 0, 1, ..., count - 1.
    pub(super) fn below(&mut self, count: usize) -> usize {
        (self.uniform() * count as f64) as usize
    }

    /// Standard normal, by Box and Muller.
    pub(super) fn normal(&mut self) -> f64 {
        let radius = (-2.0 * (1.0 - self.uniform()).ln()).sqrt();
        radius * (std::f64::consts::TAU * self.uniform()).cos()
    }

    /// `count` steps from 1 downwards, with ratio 2 (in two of five cases), 3/2, 3, or a new one in [1.4, 2.5] each time.
    pub(super) fn steps(&mut self, count: usize) -> Vec<f64> {
        let fixed = [Some(2.0), Some(2.0), Some(1.5), Some(3.0), None][self.below(5)];
        let mut step = 1.0;
        let mut next = || {
            let here = step;
            step /= fixed.unwrap_or_else(|| self.within([1.4, 2.5]));
            here
        };
        (0..count).map(|_| next()).collect()
    }
}
