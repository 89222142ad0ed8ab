//! One output language a file, from a valid module.
