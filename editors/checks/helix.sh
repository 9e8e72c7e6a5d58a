# What Helix finds, and an example on the screen: a number in the colour of its theme, and a hover. `editors/try` runs it.
export TERM=xterm-256color COLORTERM=truecolor LANG=C.UTF-8
version=$(hx --version | cut -d ' ' -f 2)
health=$(hx --health hyde)
for part in 'Tree-sitter parser:' 'Highlight queries:' 'Textobject queries:' 'Indent queries:' 'hyde:'; do
    printf '%s\n' "$health" | grep "$part" | grep -q '✓' || { printf 'Helix %s: %s\n' "$version" "$health"; exit 1; }
done
cd /opt/hyde/examples/first
tmux -L hyde -f /dev/null new-session -d -x 100 -y 40 'hx first.hyde'
trap 'tmux -L hyde kill-server' EXIT
sleep 5
tmux -L hyde capture-pane -e -p >/tmp/helix.txt
# `300` of line 13 in rgb(232, 220, 160), the colour of constant.numeric in the theme that Helix brings.
grep -q '232;220;160m300' /tmp/helix.txt || { printf 'Helix %s: no colours\n' "$version"; cat /tmp/helix.txt; exit 1; }
tmux -L hyde send-keys '9ggfd'
sleep 1
tmux -L hyde send-keys ' k'
sleep 3
tmux -L hyde capture-pane -p >/tmp/helix.txt
grep -q 'torque on a shaft' /tmp/helix.txt || { printf 'Helix %s: no hover\n' "$version"; cat /tmp/helix.txt; exit 1; }
printf 'Helix %s: works\n' "$version"
