; Made by `./dev grammar` from editors/tree-sitter-hyde/queries, with the names of Helix.

; Colours. No node is captured twice, except for names with a meaning of their own at the end: then the later pattern wins.
; `./dev grammar` writes editors/helix/queries from this file.

(comment) @comment
(string) @string
(quoted_member) @string
(escape_sequence) @constant.character.escape
(doc) @string
(number) @constant.numeric
(boolean) @constant.builtin.boolean
(unit_text) @string.special

; ---- names
(type_item name: (identifier) @type)
(fmu_item name: (identifier) @type)
(short_item name: (identifier) @type)
(model name: (identifier) @type)
(connector name: (identifier) @type)
(effect name: (identifier) @type)
(function name: (identifier) @function)
(experiment name: (identifier) @type)
(study name: (identifier) @type)
(end_clause name: (identifier) @type)
(path (identifier) @type)
(package_name (identifier) @namespace)

(declarator name: (identifier) @variable)
(redeclaration name: (identifier) @variable)
(measure name: (identifier) @variable)
(account name: (identifier) @variable)
(mode_parameter name: (identifier) @variable.parameter)
(record name: (identifier) @variable)
(figure name: (identifier) @variable)
(ideal name: (identifier) @variable)
(clocked name: (identifier) @variable)
(domain name: (identifier) @variable)
(domain coordinate: (identifier) @variable)
(on_domain domain: (identifier) @variable)
(comprehension variable: (identifier) @variable)
(for_equation variable: (identifier) @variable)
(member) @variable.other.member

(argument name: (identifier) @variable.parameter)
(change name: (reference (identifier) @variable.parameter))
(layout_setting name: (identifier) @variable.parameter)

(call function: (reference . (identifier) @function .))
(discretize method: (identifier) @function)
(solve method: (identifier) @function)
(by_steps (identifier) @function)

(mode name: (identifier) @label)
(modes initial: (identifier) @label)
(exit target: (identifier) @label)
(in_mode mode: (identifier) @label)
(mark (identifier) @label)

(setting name: (identifier) @attribute)
(label name: (identifier) @variable.parameter)

; ---- words
["package" "import"] @keyword.control.import

["model" "connector" "effect" "function" "type" "experiment" "clocked" "domain" "modes" "mode" "record" "measure" "figure"
  "budget" "stored" "dissipated" "supplied" "fmu"] @keyword.storage.type
(study_kind) @keyword.storage.type
(study "calibrate" @keyword.storage.type)

(prefix) @keyword.storage.modifier
["each" "final" "redeclare"] @keyword.storage.modifier

["if" "then" "elseif" "else" "when" "elsewhen"] @keyword.control.conditional
["for" "loop"] @keyword.control.repeat
["and" "or" "not"] @keyword.operator

["add" "assert" "at" "bode" "by" "confounds" "connect" "discretize" "end" "enter" "equation" "every" "exit" "expect" "extends"
  "from" "impact" "in" "indomain" "initial" "layout" "leave" "load" "margins" "measured" "of" "on" "over" "per" "reinit" "replace"
  "replay" "signature" "skip" "solve" "start" "stimulus" "stop" "to" "vary" "with" "wrap" "wraps"] @keyword

; ---- signs
["+" "-" "*" "/" "^" "<" "<=" ">" ">=" "<>" "==" "=" "~" "±" "+/-" "+-" "%" "->" ".."] @operator
["(" ")" "[" "]" "{" "}"] @punctuation.bracket
["." "," ";" ":"] @punctuation.delimiter

; ---- names with a meaning of their own
((reference . (identifier) @constant.builtin .)
  (#any-of? @constant.builtin "time" "pi"))
((declaration type: (path . (identifier) @type.builtin .))
  (#any-of? @type.builtin "Real" "Integer" "Boolean"))
((call function: (reference . (identifier) @function.builtin .))
  (#any-of? @function.builtin "der" "pder" "pre" "sample"))
