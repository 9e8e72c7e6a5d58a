//! `hyde explain`: the page of a diagnostic code.

use crate::args::ExplainArgs;
use crate::exit::Exit;
use crate::project::{print_error, print_output};
use hyde_diag::Code;
use std::fmt::Write as _;

/// Prints the page of a code, or the list of all codes.
pub(crate) fn explain(args: &ExplainArgs) -> Exit {
    let Some(text) = &args.code else {
        let mut list = String::new();
        for code in Code::ALL {
            let _ = writeln!(list, "{code}  {}", code.title());
        }
        print_output(&list);
        return Exit::Done;
    };
    match Code::ALL
        .iter()
        .find(|code| code.as_str().eq_ignore_ascii_case(text))
    {
        Some(code) => {
            print_output(&plain(page(*code)));
            Exit::Done
        }
        None => {
            print_error(&format!(
                "error: no code is called `{text}`; `hyde explain` lists them all"
            ));
            Exit::CommandLine
        }
    }
}

/// A page for a terminal: code is set in instead of fenced, and the title has no mark.
fn plain(page: &str) -> String {
    let mut text = String::new();
    let mut code = false;
    for line in page.lines() {
        if line.starts_with("```") {
            code = !code;
        } else if code && !line.is_empty() {
            let _ = writeln!(text, "    {line}");
        } else {
            let _ = writeln!(text, "{}", line.trim_start_matches("# "));
        }
    }
    // A blank line stands on either side of a fence: one is enough.
    text.replace("\n\n\n", "\n\n")
}

macro_rules! pages {
    ($($name:ident $file:literal;)*) => {
        /// The page of a code, from the book.
        pub(super) fn page(code: Code) -> &'static str {
            match code {
                $(Code::$name => include_str!(concat!("../../../../book/src/errors/", $file, ".md")),)*
            }
        }
    };
}

pages! {
    Syntax "E0101";
    EndName "E0102";
    TooDeep "E0103";
    BadNumber "E0104";
    Misplaced "E0105";
    UnknownName "E0201";
    UnknownType "E0202";
    UnknownFunction "E0203";
    BadArguments "E0204";
    Duplicate "E0205";
    NotConstant "E0206";
    WrongType "E0207";
    BadShape "E0208";
    Cycle "E0209";
    FieldUse "E0210";
    QuantiserOnContinuous "E0211";
    ClockBorder "E0212";
    NotYet "E0213";
    PackagePath "E0214";
    BadManifest "E0215";
    NotDeclared "E0216";
    WaveSpeed "E0217";
    SiteVariables "E0218";
    UnitMismatch "E0301";
    BadUnit "E0302";
    AngleMismatch "E0303";
    ZeroPoint "E0304";
    BadConnection "E0401";
    UnknownModification "E0402";
    FinalModified "E0403";
    NoValue "E0404";
    UnboundInput "E0405";
    NotAllowed "E0406";
    TooManyEquations "E0501";
    TooFewEquations "E0502";
    MissingBoundary "E0503";
    TwoPins "E0504";
    Constrained "E0505";
    ModeEquations "E0506";
    ClockedLoop "E0507";
    ArrayEquation "E0508";
    BadPin "E0509";
    ClockedEquation "E0510";
    Jammed "E0511";
    StateChoice "E0512";
    ConflictingStarts "E0601";
    TooManyConditions "E0602";
    InitialFailed "E0603";
    StartContradicted "E0604";
    SolverFailed "E0701";
    Chattering "E0702";
    ImpactOnPin "E0703";
    AssertFailed "E0704";
    TooManyEvents "E0705";
    NotFinite "E0706";
    NoGradient "E0707";
    NoColumn "E0801";
    NoRecord "E0802";
    BadRecord "E0803";
    UndrivenInput "E0804";
    NoExperiment "E0805";
    NotAnInput "E0806";
    NoStop "E0807";
    BadSolve "E0808";
    BadSet "E0809";
    CannotReplay "E0810";
    BadResponse "E0811";
    NoResponse "E0812";
    BadSweep "E0813";
    CannotCut "E0814";
    CannotExport "E0815";
    BadFmu "E0816";
    FmuOnlyRuns "E0817";
    FmuFailed "E0818";
    BadStudy "E0901";
    NoFiles "E0902";
    CannotVary "E0903";
    CannotObserve "E0904";
    BadDiagnosis "E0905";
    NothingLearned "E0906";
}
