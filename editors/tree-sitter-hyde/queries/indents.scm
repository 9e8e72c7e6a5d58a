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
] @indent.begin

; The words of a block stand below its first one.
["end" "equation" "elseif" "else" "elsewhen" "}" ")"] @indent.branch
(equation_section "initial" @indent.branch)
