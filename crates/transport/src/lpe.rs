//! Light path expressions (Heckbert 1990; SPEC LPE-1, LPE-2).
//!
//! A path is a word from the light to the eye: `L`, one letter for each scattering event, `E`. The letters of events
//! are `D` (diffuse), `S` (specular), `G` (glossy) and `V` (volume). A regular expression selects paths:
//! `L(S|D)*E` is everything, `LS+DE` are caustics, `LDE` is direct light on diffuse surfaces.
//!
//! An expression without `G` divides glossy events between its other letters: those sharper than
//! [`SHARP_ALPHA`] count as `S`, the rest as `D`. So `L(S|D)*E` always selects the whole image (without media).
//!
//! Expressions compile to automata that read the word from its end, as a path from the camera finds it.

use std::fmt;

use etendue_scene::bsdf::{Bsdf, BsdfSample};
use etendue_scene::parameters::{ParameterSpec, Parameters};
use etendue_spectrum::Sampled;
use regex_automata::dfa::{Automaton, StartKind, dense};
use regex_automata::nfa::thompson;
use regex_automata::util::primitives::StateID;
use regex_automata::util::{start, syntax};
use regex_automata::{Anchored, MatchKind};

/// Glossy events of a microfacet width `alpha` below this count as `S` where an expression has no `G`, unless a scene says
/// otherwise.
pub const SHARP_ALPHA: f32 = 0.1;

/// The parameter by which it says so.
pub(crate) const SHARP_ALPHA_PARAMETER: ParameterSpec = ParameterSpec {
    name: "sharpalpha",
    kind: "float",
    default: "0.1",
    unit: "",
    doc: "width of microfacets below which glossy events count as S in path expressions without G, else as D",
};

/// Reads it.
pub(crate) fn read_sharp_alpha(p: &mut Parameters<'_, '_>) -> f32 {
    p.float_within(SHARP_ALPHA_PARAMETER.name, SHARP_ALPHA, [0.0, 1.0])
}

/// The most expressions that one render can have.
pub const MAX_EXPRESSIONS: usize = 32;

/// The most layers that a method fills by itself.
const MAX_OWN_LAYERS: usize = 4;
const MAX_LAYERS: usize = MAX_EXPRESSIONS + MAX_OWN_LAYERS;

/// Names that layers cannot have, since films have channels of these names.
const RESERVED_NAMES: [&str; 9] = ["Albedo", "N", "Ns", "P", "depth", "halfA", "halfB", "sums", "variance"];

/// A scattering event along a path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event {
    /// `D`.
    Diffuse,
    /// `G`, or `S` where there is no `G`.
    SharpGlossy,
    /// `G`, or `D` where there is no `G`.
    WideGlossy,
    /// `S`.
    Specular,
    /// `V`.
    Volume,
}

impl Event {
    /// The event of a sampled direction, where glossy lobes narrower than `sharp_alpha` are sharp.
    #[inline]
    #[must_use]
    pub fn of(sample: &BsdfSample, sharp_alpha: f32) -> Self {
        if sample.is_specular() {
            Self::Specular
        } else if sample.lobe.is_glossy() {
            Self::glossy(sample.roughness, sharp_alpha)
        } else {
            Self::Diffuse
        }
    }

    /// The same, but that all glossy lobes of the surface are sharp, or none: what photon maps hold and what rays follow is
    /// divided by surfaces, before a direction is known.
    #[inline]
    #[must_use]
    pub(crate) fn at(bsdf: &Bsdf, sample: &BsdfSample, sharp_alpha: f32) -> Self {
        match Self::of(sample, sharp_alpha) {
            Self::SharpGlossy | Self::WideGlossy => Self::glossy(bsdf.glossy_roughness(), sharp_alpha),
            event => event,
        }
    }

    /// The event of a glossy lobe of that microfacet width, where those narrower than `sharp_alpha` are sharp.
    #[must_use]
    pub fn glossy(alpha: f32, sharp_alpha: f32) -> Self {
        if alpha < sharp_alpha { Self::SharpGlossy } else { Self::WideGlossy }
    }

    const fn byte(self) -> u8 {
        match self {
            Self::Diffuse => b'D',
            Self::SharpGlossy => b's',
            Self::WideGlossy => b'd',
            Self::Specular => b'S',
            Self::Volume => b'V',
        }
    }
}

/// Why an expression is refused.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ExpressionError {
    /// The expression as written.
    pub expression: String,
    /// What is wrong with it.
    pub reason: String,
}

impl fmt::Display for ExpressionError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "path expression '{}': {}", self.expression, self.reason)
    }
}

impl std::error::Error for ExpressionError {}

/// A compiled expression.
#[derive(Clone)]
pub struct PathExpression {
    automaton: dense::DFA<Vec<u32>>,
    start: StateID,
}

impl fmt::Debug for PathExpression {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "PathExpression({} bytes)", self.automaton.memory_usage())
    }
}

impl PathExpression {
    /// Compiles an expression over the letters `L D S G V E` with the operators of regular expressions.
    ///
    /// # Errors
    /// For other letters, and where the expression is not a regular one.
    pub fn new(expression: &str) -> Result<Self, ExpressionError> {
        let refuse = |reason: String| ExpressionError { expression: expression.to_owned(), reason };
        let pattern = translate(expression).map_err(&refuse)?;
        let automaton = dense::Builder::new()
            .configure(dense::Config::new().match_kind(MatchKind::All).start_kind(StartKind::Anchored))
            .thompson(thompson::Config::new().reverse(true).utf8(false))
            .syntax(syntax::Config::new().unicode(false).utf8(false))
            .build(&pattern)
            .map_err(|error| refuse(deepest_cause(&error)))?;
        let start = automaton
            .start_state(&start::Config::new().anchored(Anchored::Yes))
            .map_err(|error| refuse(error.to_string()))?;
        Ok(Self { automaton, start })
    }

    /// True if the expression selects the path with these events, from the light to the eye.
    #[must_use]
    pub fn matches(&self, events: &[Event]) -> bool {
        let mut state = self.automaton.next_state(self.start, b'E');
        for event in events.iter().rev() {
            state = self.automaton.next_state(state, event.byte());
        }
        self.accepts_light(state)
    }

    /// Whether it accepts light of a path in that state which goes on by an event and by those of a photon, from its end back to
    /// its light.
    fn accepts_trail(&self, state: StateID, event: Event, trail: impl Iterator<Item = Event>) -> bool {
        let state = self.automaton.next_state(state, event.byte());
        self.accepts_light(trail.fold(state, |state, event| self.automaton.next_state(state, event.byte())))
    }

    fn accepts_light(&self, state: StateID) -> bool {
        let state = self.automaton.next_state(state, b'L');
        self.automaton.is_match_state(self.automaton.next_eoi_state(state))
    }
}

fn deepest_cause(error: &dyn std::error::Error) -> String {
    let mut cause = error;
    while let Some(next) = cause.source() {
        cause = next;
    }
    cause.to_string().lines().last().unwrap_or_default().trim_start_matches("error: ").to_owned()
}

/// The expression over the bytes of events: glossy letters are divided or joined, see the module's text.
fn translate(expression: &str) -> Result<String, String> {
    let has_glossy = expression.contains('G');
    let mut pattern = String::from("(?:");
    let mut in_class = false;
    for letter in expression.chars() {
        in_class = match letter {
            '[' => true,
            ']' => false,
            _ => in_class,
        };
        let bytes = match letter {
            'G' => "sd",
            'S' if !has_glossy => "Ss",
            'D' if !has_glossy => "Dd",
            '.' if !in_class => "DsdSV",
            'L'
            | 'S'
            | 'D'
            | 'V'
            | 'E'
            | '['
            | ']'
            | '('
            | ')'
            | '|'
            | '*'
            | '+'
            | '?'
            | '{'
            | '}'
            | ','
            | '^'
            | '0'..='9' => {
                pattern.push(letter);
                continue;
            }
            ' ' => continue,
            other => return Err(format!("'{other}' is not a letter or operator; letters are L D S G V E")),
        };
        if in_class {
            pattern.push_str(bytes);
        } else {
            pattern.push('[');
            pattern.push_str(bytes);
            pattern.push(']');
        }
    }
    if !expression.contains('L') || !expression.contains('E') {
        return Err("a path begins with L and ends with E".to_owned());
    }
    pattern.push(')');
    Ok(pattern)
}

/// All expressions of a render, with the names of their layers.
#[derive(Clone, Debug, Default)]
pub struct PathExpressions {
    names: Vec<String>,
    expressions: Vec<PathExpression>,
    /// The places of the method's own layers among the names; `None` for those whose name an expression has.
    own: Vec<Option<usize>>,
}

impl PathExpressions {
    /// Compiles named expressions.
    ///
    /// # Errors
    /// For the first expression that is refused, for a name that is used twice or is not a word, and beyond
    /// [`MAX_EXPRESSIONS`].
    pub fn new(named: &[(String, String)]) -> Result<Self, ExpressionError> {
        let mut result = Self::default();
        for (name, expression) in named {
            let refuse =
                |reason: &str| ExpressionError { expression: expression.clone(), reason: reason.to_owned() };
            if result.names.len() == MAX_EXPRESSIONS {
                return Err(refuse("a render can have at most 32 expressions"));
            }
            if result.names.contains(name) {
                return Err(refuse("its name is used twice"));
            }
            if name.is_empty() || !name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-') {
                return Err(refuse("its name must consist of letters, digits, '_' and '-'"));
            }
            if RESERVED_NAMES.contains(&name.as_str()) {
                return Err(refuse(&format!("its name \"{name}\" is that of another layer of the film")));
            }
            result.expressions.push(PathExpression::new(expression)?);
            result.names.push(name.clone());
        }
        Ok(result)
    }

    /// The same with layers that a method fills by itself; where an expression has the name of one, it is the expression that
    /// counts.
    #[must_use]
    pub fn with_own_layers(mut self, names: &[&str]) -> Self {
        debug_assert!(names.len() <= MAX_OWN_LAYERS);
        self.names.truncate(self.expressions.len());
        self.own.clear();
        for name in names {
            let is_new = !self.names.iter().any(|other| other == name);
            self.own.push(is_new.then_some(self.names.len()));
            if is_new {
                self.names.push((*name).to_owned());
            }
        }
        self
    }

    /// Names of the layers.
    #[must_use]
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// True if there are none.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.expressions.is_empty()
    }

    /// A recorder, at the eye.
    #[must_use]
    pub fn recorder(&self) -> LayerRecorder<'_> {
        let mut recorder = LayerRecorder {
            expressions: &self.expressions,
            own: &self.own,
            n_layers: self.names.len(),
            states: [StateID::ZERO; MAX_EXPRESSIONS],
            radiance: [Sampled::ZERO; MAX_LAYERS],
            single: [0.0; MAX_EXPRESSIONS],
        };
        recorder.restart();
        recorder
    }
}

/// How far each automaton has come along a path.
#[derive(Clone, Copy, Debug)]
pub struct PathPosition([StateID; MAX_EXPRESSIONS]);

/// Follows a path from the eye and gathers what each expression selects.
#[derive(Clone, Debug)]
pub struct LayerRecorder<'e> {
    expressions: &'e [PathExpression],
    own: &'e [Option<usize>],
    n_layers: usize,
    states: [StateID; MAX_EXPRESSIONS],
    /// Layers by expression come first.
    radiance: [Sampled; MAX_LAYERS],
    /// Radiance of the first wavelength, of layers by expression, that is still to be settled.
    single: [f32; MAX_EXPRESSIONS],
}

impl LayerRecorder<'_> {
    /// True if there is nothing to record.
    #[inline]
    #[must_use]
    pub const fn is_idle(&self) -> bool {
        self.expressions.is_empty()
    }

    /// Forgets the path so far and stands at the eye again.
    pub fn restart(&mut self) {
        for (index, expression) in self.expressions.iter().enumerate() {
            self.states[index] = expression.automaton.next_state(expression.start, b'E');
        }
        self.radiance[..self.n_layers].fill(Sampled::ZERO);
        self.single[..self.expressions.len()].fill(0.0);
    }

    /// How far the path has come, to go on from there several times.
    #[must_use]
    pub fn position(&self) -> PathPosition {
        PathPosition(self.states)
    }

    /// Goes back to where the path was, and keeps what it brought.
    pub fn return_to(&mut self, position: &PathPosition) {
        self.states = position.0;
    }

    /// The path goes on through an event.
    pub fn scatter(&mut self, event: Event) {
        for (state, expression) in self.states.iter_mut().zip(self.expressions) {
            *state = expression.automaton.next_state(*state, event.byte());
        }
    }

    /// The path so far ends at a light and brings this radiance.
    pub fn emit(&mut self, radiance: Sampled) {
        for (index, expression) in self.expressions.iter().enumerate() {
            if expression.accepts_light(self.states[index]) {
                self.radiance[index] += radiance;
            }
        }
    }

    /// The path so far, continued by one event, ends at a light and brings this radiance.
    pub fn emit_through(&mut self, event: Event, radiance: Sampled) {
        for (index, expression) in self.expressions.iter().enumerate() {
            let state = expression.automaton.next_state(self.states[index], event.byte());
            if expression.accepts_light(state) {
                self.radiance[index] += radiance;
            }
        }
    }

    /// The path so far, continued by one event and by those of a photon, from its end back to its light, brings this radiance.
    pub fn emit_trail(
        &mut self,
        event: Event,
        trail: impl Iterator<Item = Event> + Clone,
        radiance: Sampled,
    ) {
        for (index, expression) in self.expressions.iter().enumerate() {
            if expression.accepts_trail(self.states[index], event, trail.clone()) {
                self.radiance[index] += radiance;
            }
        }
    }

    /// The same for radiance of the first wavelength alone, whose weight is not known before the path ends:
    /// [`Self::settle_single`] tells it.
    pub fn emit_single_trail(
        &mut self,
        event: Event,
        trail: impl Iterator<Item = Event> + Clone,
        radiance: f32,
    ) {
        for (index, expression) in self.expressions.iter().enumerate() {
            if expression.accepts_trail(self.states[index], event, trail.clone()) {
                self.single[index] += radiance;
            }
        }
    }

    /// Adds what came by [`Self::emit_single_trail`], times a factor.
    pub fn settle_single(&mut self, factor: f32) {
        for (radiance, single) in self.radiance.iter_mut().zip(&mut self.single[..self.expressions.len()]) {
            radiance[0] += *single * factor;
            *single = 0.0;
        }
    }

    /// Adds to one of the method's own layers.
    #[inline]
    pub fn add_own(&mut self, index: usize, radiance: Sampled) {
        if let Some(Some(place)) = self.own.get(index) {
            self.radiance[*place] += radiance;
        }
    }

    /// Radiance of each layer.
    #[must_use]
    pub fn radiance(&self) -> &[Sampled] {
        &self.radiance[..self.n_layers]
    }

    /// Multiplies the radiance of each layer, as by the weight of the camera.
    pub fn scale(&mut self, factor: f32) {
        for radiance in &mut self.radiance[..self.n_layers] {
            *radiance *= factor;
        }
    }
}

#[cfg(test)]
mod tests;
