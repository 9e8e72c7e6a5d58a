//! [`Outcome`]: what became of a case, and its bytes.

/// Why a case has no measures.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Fault {
    /// The code of the diagnostic.
    pub code: String,
    /// What happened.
    pub reason: String,
    /// The equation or condition, as written.
    pub equation: String,
    /// Where that stands: `axis.hyde:12`.
    pub source: String,
    /// When, in s; NaN before the start.
    pub time_s: f64,
}

/// What was kept over time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Trajectory {
    /// The instants of the rows in s.
    pub time: Vec<f64>,
    /// One column for each variable kept, SI.
    pub columns: Vec<Vec<f64>>,
}

/// What became of a case.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Outcome {
    /// The measures and expectations, SI; none of a case that failed.
    pub measures: Vec<f64>,
    /// Why it failed, if it did.
    pub fault: Option<Fault>,
    /// Steps of the solver.
    pub steps: u64,
    /// Instants with events.
    pub events: u64,
    /// What was kept over time, if anything was asked for.
    pub trajectory: Option<Trajectory>,
}

impl Outcome {
    /// A case that failed.
    #[must_use]
    pub fn failed(fault: Fault) -> Self {
        Self {
            fault: Some(fault),
            ..Self::default()
        }
    }

    /// The bytes of an outcome: lengths and numbers of 64 bits, least significant byte first.
    #[must_use]
    pub fn encode(&self) -> Vec<u8> {
        let mut out = Vec::new();
        put(&mut out, self.steps);
        put(&mut out, self.events);
        put_numbers(&mut out, &self.measures);
        match &self.fault {
            None => put(&mut out, 0),
            Some(fault) => {
                put(&mut out, 1);
                for text in [&fault.code, &fault.reason, &fault.equation, &fault.source] {
                    put(&mut out, text.len() as u64);
                    out.extend_from_slice(text.as_bytes());
                }
                put(&mut out, fault.time_s.to_bits());
            }
        }
        match &self.trajectory {
            None => put(&mut out, 0),
            Some(trajectory) => {
                put(&mut out, 1);
                put_numbers(&mut out, &trajectory.time);
                put(&mut out, trajectory.columns.len() as u64);
                for column in &trajectory.columns {
                    put_numbers(&mut out, column);
                }
            }
        }
        out
    }

    /// The outcome of these bytes; `None` if they are not those of one.
    #[must_use]
    pub fn decode(bytes: &[u8]) -> Option<Self> {
        let mut bytes = bytes;
        let (steps, events) = (take(&mut bytes)?, take(&mut bytes)?);
        let measures = take_numbers(&mut bytes)?;
        let fault = match take(&mut bytes)? {
            0 => None,
            _ => Some(Fault {
                code: take_text(&mut bytes)?,
                reason: take_text(&mut bytes)?,
                equation: take_text(&mut bytes)?,
                source: take_text(&mut bytes)?,
                time_s: f64::from_bits(take(&mut bytes)?),
            }),
        };
        let trajectory = match take(&mut bytes)? {
            0 => None,
            _ => {
                let time = take_numbers(&mut bytes)?;
                let count = take(&mut bytes)?;
                let columns = (0..count)
                    .map(|_| take_numbers(&mut bytes))
                    .collect::<Option<_>>()?;
                Some(Trajectory { time, columns })
            }
        };
        bytes.is_empty().then_some(Self {
            measures,
            fault,
            steps,
            events,
            trajectory,
        })
    }
}

fn put(out: &mut Vec<u8>, number: u64) {
    out.extend_from_slice(&number.to_le_bytes());
}

fn put_numbers(out: &mut Vec<u8>, numbers: &[f64]) {
    put(out, numbers.len() as u64);
    for number in numbers {
        put(out, number.to_bits());
    }
}

fn take(bytes: &mut &[u8]) -> Option<u64> {
    let (head, rest) = bytes.split_first_chunk::<8>()?;
    *bytes = rest;
    Some(u64::from_le_bytes(*head))
}

fn take_bytes<'b>(bytes: &mut &'b [u8], length: u64) -> Option<&'b [u8]> {
    let (head, rest) = bytes.split_at_checked(usize::try_from(length).ok()?)?;
    *bytes = rest;
    Some(head)
}

fn take_text(bytes: &mut &[u8]) -> Option<String> {
    let length = take(bytes)?;
    String::from_utf8(take_bytes(bytes, length)?.to_vec()).ok()
}

fn take_numbers(bytes: &mut &[u8]) -> Option<Vec<f64>> {
    let length = take(bytes)?.checked_mul(8)?;
    let mut part = take_bytes(bytes, length)?;
    let mut numbers = Vec::with_capacity(part.len() / 8);
    while let Some(bits) = take(&mut part) {
        numbers.push(f64::from_bits(bits));
    }
    Some(numbers)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_outcome_comes_back_and_nothing_shorter_does() {
        let fault = Fault {
            code: "E0701".to_owned(),
            reason: "größer".to_owned(),
            equation: String::new(),
            source: "a.hyde:3".to_owned(),
            time_s: 0.25,
        };
        let full = Outcome {
            measures: vec![1.5, f64::INFINITY],
            fault: Some(fault),
            steps: 12,
            events: 3,
            trajectory: Some(Trajectory {
                time: vec![0.0, 1.0],
                columns: vec![vec![2.0, 3.0], vec![]],
            }),
        };
        for outcome in [full, Outcome::default()] {
            let bytes = outcome.encode();
            assert_eq!(Outcome::decode(&bytes), Some(outcome));
            for end in 0..bytes.len() {
                assert_eq!(Outcome::decode(&bytes[..end]), None);
            }
        }
    }
}
