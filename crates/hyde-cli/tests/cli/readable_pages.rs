//! Pages on a phone, on paper and with dark colours, in a browser: nothing is cut off, and texts can be read.

use crate::command::{Folder, errors, hyde, status};
use crate::live::browser::Browser;
use serde_json::json;

/// A phone, and the text of an A4 page, in px.
const PHONE: u32 = 390;
const PAPER: u32 = 672;

/// What reaches beyond the right edge and is in nothing that scrolls, nor out of sight for good: its first words.
const CUT_OFF: &str = "JSON.stringify([...document.querySelectorAll('body *')].filter(own => \
    own.getBoundingClientRect().right > innerWidth + 1 && \
    (matchMedia('print').matches || !own.closest('.scroll') && !own.closest('pre')) && !own.closest('svg *')) \
    .map(own => own.outerHTML.slice(0, 80)))";

/// The contrast of each text with its page, the least (WCAG 2.2, relative luminance); those of figures apart.
const LEAST_CONTRAST: &str = "(() => { \
    const light = colour => { \
      const [r, g, b] = colour.match(/[0-9.]+/g).map(Number).map(c => c / 255) \
        .map(c => c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4); \
      return 0.2126 * r + 0.7152 * g + 0.0722 * b; }; \
    const behind = own => { \
      const colour = own ? getComputedStyle(own).backgroundColor : 'rgb(255, 255, 255)'; \
      return colour == 'rgba(0, 0, 0, 0)' ? behind(own.parentElement) : colour; }; \
    const texts = [...document.querySelectorAll('h1, h2, h3, p, dt, dd, a, th, td, li span, li b, pre, figcaption, footer')]; \
    return Math.min(...texts.filter(own => own.textContent.trim()).map(own => { \
      const [a, b] = [light(getComputedStyle(own).color), light(behind(own))]; \
      return (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05); })); })()";

/// Looks at a page in a browser, if there is one.
pub(crate) fn is_readable(page: &str) {
    let Some(name) = crate::report::browser_or_say() else {
        return;
    };
    let mut browser = Browser::open(name, &Folder::new(), &format!("file://{page}"));
    browser.wait("document.readyState == 'complete' && document.querySelector('footer') != null");
    shows_well(&mut browser, page);
}

/// Looks at the page that a browser shows, on every medium.
pub(crate) fn shows_well(browser: &mut Browser, page: &str) {
    for (width, media, colours) in [
        (PHONE, "screen", "light"),
        (PHONE, "screen", "dark"),
        (PAPER, "print", "light"),
        (1280, "screen", "dark"),
    ] {
        browser.show(width, media, colours);
        let here = format!("{page}: {width} px, {media}, {colours}");
        let wide = browser.value("document.documentElement.scrollWidth - innerWidth");
        assert!(wide.as_f64().unwrap() <= 0.0, "{here}: {wide} px too wide");
        assert_eq!(browser.value(CUT_OFF), json!("[]"), "{here}");
        let contrast = browser.value(LEAST_CONTRAST).as_f64().unwrap();
        assert!(
            contrast >= 4.5,
            "{here}: a text has the contrast {contrast}"
        );
    }
}

const LAG: &str = r#"package lag "a mass on a spring, pushed";
import SI.*;
import Translational.*;

model Pushed "a mass on a spring"
  input Force F;
  Drive push(F = F);
  Mass body(M = 2 [kg]);
  SpringDamper spring(c = 2e3 [N/m], d = 4 [N.s/m]);
  Fixed wall;
equation
  connect(push.a, body.a, spring.a);
  connect(spring.b, wall.a);
end Pushed;

experiment shove of Pushed "pushed at once"
  stimulus F = 10 [N];
  measure Length way = max(body.s);
  expect max(body.s) < 1 [m] "it does not go far";
  bode from F to body.s over 1 [Hz] .. 20 [Hz];
  stop 1 [s] every 1 [ms];
end shove;
"#;

#[test]
fn pages_of_runs_responses_and_modes_are_read_on_a_phone_on_paper_and_in_the_dark() {
    let folder = Folder::new();
    let model = folder.file("lag.hyde", LAG);
    for (command, page) in [
        ("run", "report.html"),
        ("bode", "bode.html"),
        ("modes", "modes.html"),
    ] {
        let out = folder.path(command);
        let output = hyde(&[command, &model, "--out", &out, "--quiet"]);
        assert_eq!(status(&output), 0, "{}", errors(&output));
        is_readable(&format!("{out}/{page}"));
    }
}
