//! Branches of choices: which ways lead to a node.

/// Branches of choices that take both in a box. Two bits for each choice: its first branch, and its
/// second.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Branches(u64);

impl Branches {
    /// How many choices have bits; a branch of another choice says nothing.
    pub(super) const MOST: usize = 32;

    pub(super) const NONE: Self = Self(0);

    /// These, and a branch of the choice with this number.
    pub(super) fn with(self, choice: usize, is_first: bool) -> Self {
        if choice >= Self::MOST {
            return self;
        }
        Self(self.0 | 1 << (2 * choice + usize::from(!is_first)))
    }

    /// Those that two ways have in common.
    pub(super) fn common(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }

    pub(super) fn has(self, choice: usize, is_first: bool) -> bool {
        self.0 & Self::NONE.with(choice, is_first).0 != 0
    }
}
