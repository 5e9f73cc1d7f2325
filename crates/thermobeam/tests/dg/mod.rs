//! The laws of the scheme of any order.

mod allocation;
mod balance;
mod contact;
mod experiment;
mod failure;
mod first_member;
mod steady;
