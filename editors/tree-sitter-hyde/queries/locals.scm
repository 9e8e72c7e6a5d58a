; A name is known in the class, loop or mode that declares it.

[
  (model)
  (connector)
  (effect)
  (function)
  (experiment)
  (study)
  (clocked)
  (mode)
  (for_equation)
  (array)
] @local.scope

(declarator name: (identifier) @local.definition)
(mode_parameter name: (identifier) @local.definition)
(record name: (identifier) @local.definition)
(domain name: (identifier) @local.definition)
(for_equation variable: (identifier) @local.definition)
(comprehension variable: (identifier) @local.definition)

(reference . (identifier) @local.reference)
