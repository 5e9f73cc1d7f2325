//! Functions of x, s or t as values of a document.

use convergence_study::input::{Field, InputError, Misread};

use crate::expression::{Expression, NotFinite, Variable};

/// What a field says as a function.
pub(crate) trait FunctionField {
    /// A function of `variable`; a complaint points into the text.
    fn expression(&self, variable: Variable) -> Result<Expression, InputError>;

    /// Refuses a function that is not finite on [0, end], nor its derivatives up to `order`.
    fn finite(&self, function: &Expression, end: f64, order: usize) -> Result<(), InputError>;

    /// The complaint about a function that is not finite somewhere.
    fn not_finite(&self, found: NotFinite) -> InputError;
}

impl FunctionField for Field<'_> {
    fn expression(&self, variable: Variable) -> Result<Expression, InputError> {
        let expected = format!("a function of {} in quotes, such as \"1 - {}\"", variable.name(), variable.name());
        self.parsed(&expected, |text| {
            Expression::parse(text, variable).map_err(|error| Misread {
                offset: error.offset,
                reason: format!("{}\n{}", error.problem, error.excerpt()),
            })
        })
    }

    fn finite(&self, function: &Expression, end: f64, order: usize) -> Result<(), InputError> {
        function.check_finite_up_to(end, order).map_err(|found| self.not_finite(found))
    }

    fn not_finite(&self, found: NotFinite) -> InputError {
        self.invalid(found.to_string())
    }
}
