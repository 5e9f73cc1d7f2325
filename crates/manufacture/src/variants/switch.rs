//! What a variant switches off, its name, and its words.

use serde::Serialize;

/// What a variant switches off.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[serde(tag = "part", content = "name", rename_all = "snake_case")]
pub enum Switch {
    /// All that acts along a coordinate.
    Coordinate(String),
    /// All that acts along time, by its name.
    Time(String),
    /// The data of a side, such as `x_max`.
    Face(String),
    /// Both sides of a coordinate.
    BothFaces(String),
    /// All sides that have data.
    AllFaces,
    /// All sides that have data, but this.
    AllFacesBut(String),
    /// The data at the first time.
    Initial,
    /// All sides that have data, and the data at the first time.
    AllFacesAndInitial,
    /// The term of a parameter.
    Parameter(String),
    /// What acts on a field.
    Field(String),
}

impl Switch {
    /// The name of the variant.
    pub fn variant(&self) -> String {
        match self {
            Switch::Coordinate(name) | Switch::Time(name) | Switch::Field(name) => {
                format!("constant_{name}")
            }
            Switch::Face(name) | Switch::BothFaces(name) => format!("flat_{name}"),
            Switch::AllFaces => "flat_faces".to_owned(),
            Switch::AllFacesBut(name) => format!("flat_but_{name}"),
            Switch::Initial => "flat_initial".to_owned(),
            Switch::AllFacesAndInitial => "flat_everywhere".to_owned(),
            Switch::Parameter(name) => format!("zero_{name}"),
        }
    }

    /// What the variant switches off, in words.
    pub fn words(&self) -> String {
        match self {
            Switch::Coordinate(name) | Switch::Time(name) => format!("all that acts along {name}"),
            Switch::Face(name) => format!("the data at {name}"),
            Switch::BothFaces(name) => format!("the data at {name}_min and {name}_max"),
            Switch::AllFaces => "the data at all faces".to_owned(),
            Switch::AllFacesBut(name) => format!("the data at all faces but {name}"),
            Switch::Initial => "the data at the first time".to_owned(),
            Switch::AllFacesAndInitial => "the data at all faces and at the first time".to_owned(),
            Switch::Parameter(name) => format!("the terms with {name}"),
            Switch::Field(name) => format!("all that acts on {name}"),
        }
    }
}
