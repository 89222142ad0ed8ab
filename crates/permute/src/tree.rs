//! A decision tree over the settings that compositions asked for. It predicts, without composing,
//! whether another permutation gives a text that is known already.

use std::collections::BTreeMap;

use super::{Setting, Settings};

/// A tree of questions, with a `T` for every sequence of answers seen so far.
///
/// What a composition asks next depends only on earlier answers. So all compositions of one entry
/// point ask the same first question, those with the same answer ask the same second one, and so
/// on.
#[derive(Debug, Clone)]
pub struct ReadTree<T> {
    /// The first node is the root, once there is one.
    nodes: Vec<TreeNode<T>>,
}

#[derive(Debug, Clone)]
enum TreeNode<T> {
    Leaf(T),
    Question { name: String, answers: BTreeMap<Setting, usize> },
}

/// Two compositions asked different questions after the same answers. That is a bug in what
/// recorded them.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Contradiction;

impl<T> Default for ReadTree<T> {
    fn default() -> Self {
        Self { nodes: Vec::new() }
    }
}

impl<T> ReadTree<T> {
    /// Adds a sequence of questions and answers, each question once, with what it led to. A
    /// sequence that is known keeps what it had. A contradiction changes nothing.
    pub fn insert(&mut self, reads: &[(String, Setting)], value: T) -> Result<(), Contradiction> {
        let mut node = 0;
        for (depth, (name, answer)) in reads.iter().enumerate() {
            match self.nodes.get(node) {
                None => return self.grow(&reads[depth..], value),
                Some(TreeNode::Question { name: known, answers }) if known == name => match answers
                    .get(answer)
                {
                    Some(next) => node = *next,
                    None => return self.branch(node, answer.clone(), &reads[depth + 1..], value),
                },
                Some(_) => return Err(Contradiction),
            }
        }
        match self.nodes.get(node) {
            None => self.grow(&[], value),
            Some(TreeNode::Leaf(_)) => Ok(()),
            Some(TreeNode::Question { .. }) => Err(Contradiction),
        }
    }

    /// What a composition with these settings led to, if one that asks the same and gets the same
    /// answers is known. `None` also if a setting that is asked for has no value.
    pub fn get(&self, settings: &Settings) -> Option<&T> {
        let mut node = 0;
        loop {
            match self.nodes.get(node)? {
                TreeNode::Leaf(value) => return Some(value),
                TreeNode::Question { name, answers } => {
                    node = *answers.get(settings.value(name)?)?
                }
            }
        }
    }

    /// Every leaf, in the order added.
    pub fn leaves(&self) -> impl Iterator<Item = &T> {
        self.nodes.iter().filter_map(|node| match node {
            TreeNode::Leaf(value) => Some(value),
            TreeNode::Question { .. } => None,
        })
    }

    fn branch(
        &mut self,
        node: usize,
        answer: Setting,
        rest: &[(String, Setting)],
        value: T,
    ) -> Result<(), Contradiction> {
        let next = self.nodes.len();
        if let Some(TreeNode::Question { answers, .. }) = self.nodes.get_mut(node) {
            answers.insert(answer, next);
        }
        self.grow(rest, value)
    }

    /// Appends a chain of questions that ends in a leaf.
    fn grow(&mut self, reads: &[(String, Setting)], value: T) -> Result<(), Contradiction> {
        for (name, answer) in reads {
            let next = self.nodes.len() + 1;
            self.nodes.push(TreeNode::Question {
                name: name.clone(),
                answers: BTreeMap::from([(answer.clone(), next)]),
            });
        }
        self.nodes.push(TreeNode::Leaf(value));
        Ok(())
    }
}
