//! [`Running`]: a run together with the model that it borrows, so that an instance can own both.

use crate::model::Model;
use hyde_experiment::RunError;
use hyde_sim::{Session, Setup};
use std::sync::Arc;

self_cell::self_cell!(
    /// What a run is told, beside the model.
    struct Prepared {
        owner: Arc<Model>,
        #[covariant]
        dependent: Setup,
    }
);

self_cell::self_cell!(
    /// A run beside what it is told.
    pub(crate) struct Running {
        owner: Prepared,
        #[not_covariant]
        dependent: Session,
    }
);

/// Times and tolerance from an importer.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub(crate) struct Asked {
    pub(crate) start_s: Option<f64>,
    pub(crate) stop_s: Option<f64>,
    pub(crate) rtol: Option<f64>,
}

impl Running {
    /// Starts a run of a model with these parameters.
    pub(crate) fn start(
        model: &Arc<Model>,
        asked: Asked,
        parameters: Vec<f64>,
    ) -> Result<Self, RunError> {
        let prepared = Prepared::try_new(Arc::clone(model), |model| {
            let mut setup = model.setup(asked.start_s, asked.stop_s, asked.rtol)?;
            setup.parameters = parameters;
            Ok::<_, RunError>(setup)
        })?;
        Self::try_new(prepared, |prepared| {
            let program = &prepared.borrow_owner().program;
            Session::start(program, prepared.borrow_dependent()).map_err(RunError::Failed)
        })
    }

    /// Does something with the run.
    pub(crate) fn with<T>(&mut self, work: impl FnOnce(&mut Session<'_>) -> T) -> T {
        self.with_dependent_mut(|_, session| work(session))
    }
}
