; `maf` and `]f`: an equation section or an experiment; `mat` and `]t`: a class; `maa`: an argument.

[(model) (connector) (effect)] @class.around
[(function) (experiment) (study)] @function.around
(arguments (argument) @parameter.inside)
(modification (change) @parameter.inside)
(comment) @comment.around
