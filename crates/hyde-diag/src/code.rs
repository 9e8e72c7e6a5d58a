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
    Misplaced "E0105" "an equation is among the declarations";
    UnknownName "E0201" "an unknown name";
    UnknownType "E0202" "an unknown type or model";
    UnknownFunction "E0203" "an unknown function";
    BadArguments "E0204" "a function is called with the wrong arguments";
    Duplicate "E0205" "a name is declared twice";
    NotConstant "E0206" "the expression is not constant";
    WrongType "E0207" "expected Boolean, found number, or the reverse";
    BadShape "E0208" "an array has the wrong length, or no such element";
    Cycle "E0209" "a definition uses itself";
    FieldUse "E0210" "a field is used where it has no single value";
    QuantiserOnContinuous "E0211" "a quantiser is applied to a continuous variable";
    ClockBorder "E0212" "a clocked boundary is crossed without `sample` or `hold`";
    NotYet "E0213" "a part of the language that this version parses but does not run";
    PackagePath "E0214" "the name of a package does not match its file";
    BadManifest "E0215" "a manifest cannot be used";
    NotDeclared "E0216" "a file is not declared, or is outside its folder";
    WaveSpeed "E0217" "the number of cells of a field is not known";
    SiteVariables "E0218" "the variables after `over` are wrong";
    UnitMismatch "E0301" "two sides have different dimensions";
    BadUnit "E0302" "a unit cannot be read";
    AngleMismatch "E0303" "two sides differ only in the angle";
    ZeroPoint "E0304" "a temperature with an offset zero point is used as a difference";
    BadConnection "E0401" "incompatible connectors are connected";
    UnknownModification "E0402" "a modification has no target";
    FinalModified "E0403" "a final parameter is modified";
    NoValue "E0404" "a parameter has no value";
    UnboundInput "E0405" "an input has no source";
    NotAllowed "E0406" "a value is not allowed";
    TooManyEquations "E0501" "a redundant equation";
    TooFewEquations "E0502" "an undetermined variable";
    MissingBoundary "E0503" "a field has no boundary condition at one end";
    TwoPins "E0504" "two modes fix the same state";
    Constrained "E0505" "states are constrained to each other";
    ModeEquations "E0506" "the modes of a block have different numbers of equations";
    ClockedLoop "E0507" "the equations of a clocked part form a loop";
    ArrayEquation "E0508" "an array equation does not determine the whole array";
    BadPin "E0509" "a mode fixes a variable that it cannot fix";
    ClockedEquation "E0510" "an equation of a clocked part is not an assignment";
    Jammed "E0511" "rigid parts block each other";
    StateChoice "E0512" "a choice of states cannot be satisfied";
    ConflictingStarts "E0601" "rigidly joined states have different start values";
    TooManyConditions "E0602" "more initial conditions than states";
    InitialFailed "E0603" "no consistent initial conditions were found";
    StartContradicted "E0604" "a start value contradicts the others";
    SolverFailed "E0701" "the solver failed";
    Chattering "E0702" "an endless sequence of events at one instant";
    ImpactOnPin "E0703" "a state jumps when a mode fixes it";
    AssertFailed "E0704" "an assert does not hold";
    TooManyEvents "E0705" "events come faster and faster";
    NotFinite "E0706" "an equation has no finite value";
    NoGradient "E0707" "the gradient of a run is not defined";
    NoColumn "E0801" "a record has no such column";
    NoRecord "E0802" "a record is missing";
    BadRecord "E0803" "a record cannot be read";
    UndrivenInput "E0804" "an input of the model is not driven";
    NoExperiment "E0805" "no such model or experiment";
    NotAnInput "E0806" "a stimulus drives a variable that is not a free input";
    NoStop "E0807" "the end of a run is not defined";
    BadSolve "E0808" "the solver has no such method, option or value";
    BadSet "E0809" "a value cannot be set";
    CannotReplay "E0810" "a replayed variable has no equation of its own";
    BadResponse "E0811" "the record is not a valid frequency response";
    NoResponse "E0812" "a frequency response is not defined here";
    BadSweep "E0813" "a sweep cannot be planned";
    CannotCut "E0814" "a loop cannot be opened at this signal";
    CannotExport "E0815" "a part of the model cannot be expressed in the exported form";
    BadFmu "E0816" "an FMU cannot be used";
    FmuOnlyRuns "E0817" "an FMU has no equations for this analysis";
    FmuFailed "E0818" "an FMU failed during a run";
    BadStudy "E0901" "a study is incomplete or invalid";
    NoFiles "E0902" "no file matches the pattern of a study";
    CannotVary "E0903" "a parameter cannot be varied";
    CannotObserve "E0904" "a model or a record cannot be observed";
    BadDiagnosis "E0905" "a diagnosis is incomplete or invalid";
    NothingLearned "E0906" "a calibration cannot determine any parameter";
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
