//! Accesses to textures.
use super::super::error::Error;
use super::super::number::Number;
use super::lane::{Env, Lane};
use super::watch::Watch;

pub(super) fn quad<N: Number>(env: Env, access: u32, lanes: &mut [Lane<N>], group: &[usize], watch: &mut Watch) -> Result<(), Error> {
    Err(Error::unsupported("textures"))
}

pub(super) fn single<N: Number>(env: Env, access: u32, memory: &mut [N], watch: &mut Watch) -> Result<(), Error> {
    Err(Error::unsupported("textures"))
}
