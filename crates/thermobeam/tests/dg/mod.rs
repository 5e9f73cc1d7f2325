//! The laws of the scheme of any order.

mod scenes;

mod allocation;
mod balance;
mod contact;
mod experiment;
mod failure;
mod first_member;
mod linear;
mod manufactured;
mod order_in_time;
mod steady;
