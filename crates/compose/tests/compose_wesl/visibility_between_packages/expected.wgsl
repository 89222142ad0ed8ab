// lib::a

fn shown() { inside(); }

// lib::b

fn inside() {}

// older::m

fn plain() {}

// package::main

fn main() { shown(); plain(); }
