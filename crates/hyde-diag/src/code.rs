//! Every diagnostic code, in one table; codes are never reused.
//!
//! E01 syntax, E02 names and types, E03 units, E04 connections and modification, E05 structure, E06 initialisation,
//! E07 simulation, E08 data and experiments, E09 studies. Each has a page in the book, `book/src/errors/`, a fixture and a test.

macro_rules! codes {
    ($($name:ident $code:literal $title:literal;)*) => {
        /// The kind of a mistake, printed as `E0503`.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub enum Code {
            $(#[doc = $title] $name,)*
        }

        impl Code {
            /// Every code, in the order of the table.
            pub const ALL: &'static [Code] = &[$(Code::$name,)*];

            /// The code as printed, `E0503`.
            #[must_use]
            pub fn as_str(self) -> &'static str {
                match self { $(Code::$name => $code,)* }
            }

            /// One line on what it means.
            #[must_use]
            pub fn title(self) -> &'static str {
                match self { $(Code::$name => $title,)* }
            }
        }
    };
}

codes! {
    Syntax "E0101" "the text does not follow the grammar";
    EndName "E0102" "the name after `end` differs from the name that was opened";
    TooDeep "E0103" "expressions or blocks are nested too deeply";
    BadNumber "E0104" "a number cannot be read";
    Misplaced "E0105" "an equation stands among the declarations";
    UnknownName "E0201" "a name stands for nothing here";
    UnknownType "E0202" "a type or model is not known";
    UnknownFunction "E0203" "a function is not known";
    BadArguments "E0204" "a function is called with the wrong arguments";
    Duplicate "E0205" "a name is declared twice";
    NotConstant "E0206" "something that must be known before the run is not";
    WrongType "E0207" "a number stands for a truth, or a truth for a number";
    BadShape "E0208" "an array has another length, or no such element";
    Cycle "E0209" "a definition uses itself";
    FieldUse "E0210" "a field is used where it has no single value";
    QuantiserOnContinuous "E0211" "a quantiser stands on a continuous variable";
    ClockBorder "E0212" "a variable crosses the border of a clocked part without sample or hold";
    NotYet "E0213" "a part of the language that this version parses but does not run";
    PackagePath "E0214" "a package is not called as its file";
    BadManifest "E0215" "a manifest cannot be used";
    NotDeclared "E0216" "a file is not declared, or lies outside its folder";
    WaveSpeed "E0217" "it is not known how many cells a field needs";
    UnitMismatch "E0301" "two sides have different dimensions";
    BadUnit "E0302" "a unit cannot be read";
    AngleMismatch "E0303" "two sides differ in the angle only";
    ZeroPoint "E0304" "a temperature with a zero point is added as a difference";
    BadConnection "E0401" "things that do not fit are connected";
    UnknownModification "E0402" "a modification changes nothing";
    FinalModified "E0403" "a final parameter is modified";
    NoValue "E0404" "a parameter has no value";
    UnboundInput "E0405" "an input has nothing to read";
    NotAllowed "E0406" "a value is not allowed";
    TooManyEquations "E0501" "equations determine nothing new";
    TooFewEquations "E0502" "unknowns that no equation determines";
    MissingBoundary "E0503" "a field has no boundary condition at one end";
    TwoPins "E0504" "two modes fix the same state";
    Constrained "E0505" "states are constrained to each other";
    ModeEquations "E0506" "the modes of a block have different numbers of equations";
    ClockedLoop "E0507" "the equations of a clocked part depend on each other in a circle";
    ArrayEquation "E0508" "an array equation determines no whole array";
    BadPin "E0509" "a mode fixes what cannot be fixed";
    ClockedEquation "E0510" "an equation of a clocked part is no assignment";
    Jammed "E0511" "rigid parts hold each other where they are";
    StateChoice "E0512" "a choice of states cannot be met";
    ConflictingStarts "E0601" "joined states start at different values";
    TooManyConditions "E0602" "more initial conditions than states";
    InitialFailed "E0603" "no consistent initial conditions were found";
    StartContradicted "E0604" "a start value contradicts the others";
    SolverFailed "E0701" "the solver could not go on";
    Chattering "E0702" "events follow each other at one instant without end";
    ImpactOnPin "E0703" "a state jumps as a mode fixes it";
    AssertFailed "E0704" "an assert does not hold";
    TooManyEvents "E0705" "events come faster and faster";
    NotFinite "E0706" "an equation has no finite value";
    NoGradient "E0707" "a run has no gradient";
    NoColumn "E0801" "a record has no such column";
    NoRecord "E0802" "a record is missing";
    BadRecord "E0803" "a record cannot be read";
    UndrivenInput "E0804" "an input of the model is not driven";
    NoExperiment "E0805" "no such model or experiment";
    NotAnInput "E0806" "a stimulus drives what is no free input";
    NoStop "E0807" "it is not said when a run ends";
    BadSolve "E0808" "the solver has no such method, option or value";
    BadSet "E0809" "a value cannot be set";
    CannotReplay "E0810" "what is replayed has no equation of its own";
    BadResponse "E0811" "a measured frequency response is none";
    NoResponse "E0812" "there is no frequency response here";
    BadSweep "E0813" "a sweep cannot be planned";
    CannotCut "E0814" "a loop cannot be cut at this signal";
    BadStudy "E0901" "a study does not say what it needs";
    NoFiles "E0902" "no file is what a study asks for";
    CannotVary "E0903" "what is to be varied cannot be";
    CannotObserve "E0904" "a model or a record cannot be observed";
    BadDiagnosis "E0905" "a diagnosis does not say what it needs";
    NothingLearned "E0906" "a calibration learns nothing";
}

impl std::fmt::Display for Code {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.as_str())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn codes_are_unique_and_ordered() {
        let texts: Vec<_> = Code::ALL.iter().map(|code| code.as_str()).collect();
        let set: BTreeSet<_> = texts.iter().copied().collect();
        assert_eq!(set.len(), texts.len());
        assert!(texts.is_sorted());
    }
}
