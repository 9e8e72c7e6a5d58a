//! What `hyde doc` shows of members that `extends` brings.

use crate::command::{Folder, errors, hyde, read, status};

const BASE: &str = "package near \"of the dependency\";
import SI.*;
import Translational.*;

model Base \"a base\"
  Rail a;
  parameter Force F = 4 [N] ~ ±20% from \"spring balance\";
  Spring spring(c = 1e4 [N/m], s_rel0 = 2 [mm]);
equation
  a.f = F;
end Base;
";

const OWN: &str = "package own \"of the package\";
import SI.*;
import near.*;

model Ext \"with another force\"
  extends Base(F = 7 [N], spring(c = 3e4 [N/m]));
  Real x;
initial equation
  x = 1;
equation
  der(x) = -x/(1 [s]);
end Ext;

model Further
  extends Ext(F = 9 [N]);
end Further;
";

#[test]
fn inherited_members_have_the_values_that_extends_gives_them() {
    let folder = Folder::new();
    folder.file("q/hyde.toml", "name = \"q\"\nversion = \"0.1.0\"\n");
    folder.file("q/near.hyde", BASE);
    let manifest = "name = \"p\"\nversion = \"0.1.0\"\n[dependencies]\nq = \"../q\"\n";
    folder.file("p/hyde.toml", manifest);
    folder.file("p/own.hyde", OWN);
    let out = folder.path("doc");
    let output = hyde(&["doc", &folder.path("p"), "--out", &out]);
    assert_eq!(status(&output), 0, "{}", errors(&output));
    let page = read(&format!("{out}/own.html"));
    let (ext, further) = page.split_once("<section id=\"Further\">").unwrap();
    for shown in [
        "extends Base with <code>F = 7 [N], spring(c = 3e4 [N/m])</code>",
        "<b>a</b> Rail",
        "<code>7 [N]</code>",
        "<code>c = 3e4 [N/m]</code>, <code>s_rel0 = 2 [mm]</code>",
        "from <code>Base</code>, modified",
        "<h4>Initial equations</h4>\n<pre>x = 1;</pre>",
    ] {
        assert!(ext.contains(shown), "`{shown}` is missing:\n{ext}");
    }
    // Neither the value of the base nor the source and the spread of that.
    for hidden in ["4 [N]</code></td>", "spring balance", "20%", "1e4"] {
        assert!(!ext.contains(hidden), "`{hidden}` is there:\n{ext}");
    }
    assert!(further.contains("<code>9 [N]</code>"), "{further}");
    assert!(!further.contains("<code>7 [N]</code>"), "{further}");
    // What is not known is said.
    let alone = folder.file("alone.hyde", &OWN.replace("import near.*;\n", ""));
    let output = hyde(&["doc", &alone, "--out", &out]);
    assert_eq!(status(&output), 0, "{}", errors(&output));
    let page = read(&format!("{out}/own.html"));
    assert!(page.contains("its members are not shown"), "{page}");
}
