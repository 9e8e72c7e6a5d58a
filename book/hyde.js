// Colours of models in the pages of this book, for highlight.js.
"use strict";

(() => {
  if (typeof hljs === "undefined") return;

  const declaring =
    "package model connector effect function type experiment calibrate diagnose sweep clocked domain record measure figure";
  const keywords = {
    keyword:
      `${declaring} import extends parameter constant final flow input output replaceable redeclare each field discretize ` +
      "indomain size shape site initial equation connect when elsewhen then end if elseif else for loop modes mode exit enter " +
      "leave add wrap replace signature confounds assert reinit with fmu on in by of from to over load every stimulus measured " +
      "replay expect solve start stop skip bode margins at budget vary per impact stored dissipated supplied layout wraps and " +
      "or not",
    literal: "true false time pi",
    built_in: "der pder pre sample",
  };
  const number = { className: "number", begin: /\b\d+(\.\d+)?([eE][-+]?\d+)?/, relevance: 0 };
  const unit = { className: "symbol", begin: /\[/, end: /(?=\])/, excludeBegin: true };

  hljs.registerLanguage("hyde", hljs => ({
    name: "Hyde",
    keywords,
    contains: [
      hljs.C_LINE_COMMENT_MODE,
      hljs.C_BLOCK_COMMENT_MODE,
      hljs.QUOTE_STRING_MODE,
      {
        beginKeywords: declaring,
        end: /[;("=]|$/,
        excludeEnd: true,
        contains: [{ className: "title", begin: /[A-Za-z_]\w*/, endsParent: true }],
        relevance: 0,
      },
      { begin: /\b\d+(\.\d+)?([eE][-+]?\d+)?\s*\[/, returnBegin: true, end: /\]/, contains: [number, unit], relevance: 0 },
      number,
      {
        className: "type",
        begin: /\b[A-Z]\w*(\.[A-Z]\w*)*(?=\s+(?!(then|else|elseif|and|or|of|in|by|on|over|with)\b)[A-Za-z_])/,
        relevance: 0,
      },
    ],
  }));

  // The pages are coloured before this file is read.
  document.querySelectorAll("code.language-hyde").forEach(block => {
    block.classList.remove("no-highlight");
    (hljs.highlightElement || hljs.highlightBlock)(block);
  });
})();
