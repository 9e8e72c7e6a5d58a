; Made by `./dev grammar` from editors/tree-sitter-hyde/queries, with the names of Helix.

; As `hyde fmt` lays a text out: two blanks for what a block contains.

[
  (model)
  (connector)
  (effect)
  (function)
  (experiment)
  (study)
  (modes)
  (mode)
  (actions)
  (clocked)
  (if_equation)
  (when_equation)
  (for_equation)
  (modification)
  (arguments)
] @indent

; The words of a block stand below its first one.
["end" "equation" "elseif" "else" "elsewhen" "}" ")"] @outdent
(equation_section "initial" @outdent)
